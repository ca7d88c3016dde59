/* Cases that replay small captures and check images of passes. */
#include "harness/replay_case.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *case_run_path(const struct case_run *run, const char *name, char path[4096]) {
    snprintf(path, 4096, "%s/%s", run->context->folder, name);
    return path;
}

/* The next word of a text; NULL after the last. */
static const char *next_word(const char **text, char word[256]) {
    *text += strspn(*text, " ");
    const int length = (int)strcspn(*text, " ");
    snprintf(word, 256, "%.*s", length, *text);
    *text += length;
    return word[0] ? word : NULL;
}

static bool is_setting(const char *word) {
    return memchr(word, '.', strcspn(word, "=")) != NULL;
}

/* Writes the preset of these words. */
static void print_preset(FILE *file, const char *words) {
    char word[256];
    const char *comma = "";
    fputs("{\"name\": \"selftest\", \"title\": \"A part of a pipeline\", \"source\": \"glint\", \"slots\": {", file);
    for (const char *at = words; next_word(&at, word);) {
        const int slot = (int)strcspn(word, "=");
        if (is_setting(word)) continue;
        fprintf(file, "%s\"%.*s\": \"%s\"", comma, slot, word, word + slot + 1);
        comma = ", ";
    }
    fputs("}, \"set\": {}}\n", file);
}

void case_run_pipeline(struct case_run *run, const char *words) {
    char path[4096], word[256], *text = NULL;
    size_t size = 0;
    if (!run->ok) return;
    glint_pipeline_destroy(&run->pipeline);
    FILE *file = open_memstream(&text, &size);
    if (file) print_preset(file, words);
    run->ok = file && fclose(file) == 0;
    if (!run->ok) glint_fail(run->err, GLINT_ERROR_MEMORY, "out of memory");
    run->ok = run->ok && case_write_text(case_run_path(run, "case.json", path), text, run->err) &&
              (run->pipeline = glint_pipeline_create(path, run->err));
    for (const char *at = words; run->ok && next_word(&at, word);)
        if (is_setting(word)) run->ok = glint_pipeline_set(run->pipeline, word, run->err);
    free(text);
}

void case_run_file(struct case_run *run, const char *path) {
    const struct glint_replay_options options = {
        .diagnostics = true, .float_precision = !run->half, .all = true, .outputs = run->outputs};
    if (!run->ok) return;
    glint_replay_load(run->replay, NULL, NULL);
    glint_capture_close(&run->capture);
    run->ok =
        (run->capture = glint_capture_open(path, NULL, run->err)) &&
        glint_replay_load(run->replay, run->capture, run->err) &&
        glint_replay_run(run->replay, run->pipeline, &options, run->context->progress, run->context->user, run->err);
}

void case_run_plain(struct case_run *run, const struct plain *plain) {
    char path[4096];
    struct plain quickly = *plain;
    quickly.compression = GLINT_NONE;
    run->ok = run->ok && plain_write(case_run_path(run, "case.exr", path), &quickly, run->err);
    case_run_file(run, path);
}

static void *image_of(struct case_run *run, const char *name, enum glint_type type, uint32_t *width, uint32_t *height) {
    if (!run->ok) return NULL;
    const struct glint_image *image = glint_replay_find_image(run->replay, name);
    if (!image) run->ok = glint_fail(run->err, GLINT_ERROR_DEVICE, "self-test: the replay made no %s", name);
    if (!run->ok) return NULL;
    if (width) *width = image->width;
    if (height) *height = image->height;
    void *out = malloc((size_t)image->width * image->height * image->components * sizeof(float));
    run->ok = out ? glint_replay_read_image(run->replay, image, type, out, run->err)
                  : glint_fail(run->err, GLINT_ERROR_MEMORY, "out of memory");
    if (run->ok) return out;
    free(out);
    return NULL;
}

float *case_run_floats(struct case_run *run, const char *name, uint32_t *width, uint32_t *height) {
    return image_of(run, name, GLINT_F32, width, height);
}

uint32_t *case_run_uints(struct case_run *run, const char *name, uint32_t *width, uint32_t *height) {
    return image_of(run, name, GLINT_U32, width, height);
}

static const struct replay_case *case_of(const struct replay_case_list *const *lists, size_t i) {
    while (i >= (*lists)->count) i -= (*lists++)->count;
    return &(*lists)->items[i];
}

size_t replay_cases_count(const struct replay_case_list *const *lists, size_t count) {
    size_t sum = 0;
    for (size_t i = 0; i < count; i++) sum += lists[i]->count;
    return sum;
}

struct glint_selftest_case replay_cases_get(const struct replay_case_list *const *lists, size_t i) {
    const struct replay_case *c = case_of(lists, i);
    return (struct glint_selftest_case){c->name, c->what, NULL, c->unit, c->bound, c->reason};
}

bool replay_cases_run(const struct replay_case_list *const *lists, size_t count, const struct case_context *context,
                      const bool *selected, struct glint_selftest_finding *findings, struct glint_error *err) {
    struct case_run run = {.context = context, .err = err};
    run.ok = (run.replay = glint_replay_create(context->device, err)) != NULL;
    for (size_t i = 0, n = replay_cases_count(lists, count); i < n; i++) {
        const struct replay_case *c = case_of(lists, i);
        if (!selected[i]) continue;
        findings[i].left_out = c->slow && context->quick;
        run.half = false;
        run.outputs = NULL;
        if (run.ok && !findings[i].left_out) c->check(&run, c, &findings[i]);
    }
    if (run.replay) glint_replay_load(run.replay, NULL, NULL);
    glint_capture_close(&run.capture);
    glint_pipeline_destroy(&run.pipeline);
    glint_replay_destroy(&run.replay);
    return run.ok;
}
