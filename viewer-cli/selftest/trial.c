/* Cases that replay small captures and look at the images of their passes. */
#include "trial.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text_file.h"

const char *trial_path(const struct trial *trial, const char *name, char path[4096]) {
    snprintf(path, 4096, "%s/%s", trial->test->folder, name);
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

/* The preset that the words make. */
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

void trial_use(struct trial *trial, const char *words) {
    char path[4096], word[256], *text = NULL;
    size_t size = 0;
    if (!trial->ok) return;
    glint_pipeline_destroy(&trial->pipeline);
    FILE *file = open_memstream(&text, &size);
    if (file) print_preset(file, words);
    trial->ok = file && fclose(file) == 0;
    if (!trial->ok) glint_fail(trial->err, GLINT_ERROR_MEMORY, "out of memory");
    trial->ok = trial->ok && text_file_write(trial_path(trial, "trial.json", path), text, trial->err) &&
                (trial->pipeline = glint_pipeline_create(path, trial->err));
    for (const char *at = words; trial->ok && next_word(&at, word);)
        if (is_setting(word)) trial->ok = glint_pipeline_set(trial->pipeline, word, trial->err);
    free(text);
}

void trial_run_file(struct trial *trial, const char *path) {
    const struct glint_replay_options options = {
        .diagnostics = true, .float_precision = !trial->half, .all = true, .outputs = trial->outputs};
    if (!trial->ok) return;
    glint_replay_load(trial->replay, NULL, NULL);
    glint_capture_close(&trial->capture);
    trial->ok = (trial->capture = glint_capture_open(path, NULL, trial->err)) &&
                glint_replay_load(trial->replay, trial->capture, trial->err) &&
                glint_replay_run(trial->replay, trial->pipeline, &options, trial->test->progress, trial->test->user,
                                 trial->err);
}

void trial_run(struct trial *trial, const struct plain *plain) {
    char path[4096];
    struct plain quickly = *plain;
    quickly.compression = GLINT_NONE;
    trial->ok = trial->ok && plain_write(trial_path(trial, "trial.exr", path), &quickly, trial->err);
    trial_run_file(trial, path);
}

static void *image_of(struct trial *trial, const char *name, enum glint_type type, uint32_t *width, uint32_t *height) {
    if (!trial->ok) return NULL;
    const struct glint_image *image = glint_replay_find_image(trial->replay, name);
    if (!image) trial->ok = glint_fail(trial->err, GLINT_ERROR_DEVICE, "self-test: the replay made no %s", name);
    if (!trial->ok) return NULL;
    if (width) *width = image->width;
    if (height) *height = image->height;
    void *out = malloc((size_t)image->width * image->height * image->components * sizeof(float));
    trial->ok = out ? glint_replay_read_image(trial->replay, image, type, out, trial->err)
                    : glint_fail(trial->err, GLINT_ERROR_MEMORY, "out of memory");
    if (trial->ok) return out;
    free(out);
    return NULL;
}

float *trial_floats(struct trial *trial, const char *name, uint32_t *width, uint32_t *height) {
    return image_of(trial, name, GLINT_F32, width, height);
}

uint32_t *trial_uints(struct trial *trial, const char *name, uint32_t *width, uint32_t *height) {
    return image_of(trial, name, GLINT_U32, width, height);
}

void compared(struct selftest_finding *finding, double error, const char *format, ...) {
    if (isnan(error)) error = INFINITY;
    finding->values++;
    if (error <= finding->worst) return;
    va_list arguments;
    va_start(arguments, format);
    finding->worst = error;
    vsnprintf(finding->at, sizeof finding->at, format, arguments);
    va_end(arguments);
}

static const struct trial_case *case_of(const struct trial_list *const *lists, size_t i) {
    while (i >= (*lists)->count) i -= (*lists++)->count;
    return &(*lists)->items[i];
}

size_t trial_count(const struct trial_list *const *lists, size_t count) {
    size_t sum = 0;
    for (size_t i = 0; i < count; i++) sum += lists[i]->count;
    return sum;
}

struct selftest_case trial_get(const struct trial_list *const *lists, size_t i) {
    const struct trial_case *c = case_of(lists, i);
    return (struct selftest_case){c->name, c->what, NULL, c->unit, c->bound, c->reason};
}

bool trial_cases(const struct trial_list *const *lists, size_t count, const struct selftest *test, const bool *chosen,
                 struct selftest_finding *findings, struct glint_error *err) {
    struct trial trial = {.test = test, .err = err};
    trial.ok = (trial.replay = glint_replay_create(test->device, err)) != NULL;
    for (size_t i = 0, n = trial_count(lists, count); i < n; i++) {
        const struct trial_case *c = case_of(lists, i);
        if (!chosen[i]) continue;
        findings[i].left_out = c->slow && test->quick;
        trial.half = false;
        trial.outputs = NULL;
        if (trial.ok && !findings[i].left_out) c->check(&trial, c, &findings[i]);
    }
    if (trial.replay) glint_replay_load(trial.replay, NULL, NULL);
    glint_capture_close(&trial.capture);
    glint_pipeline_destroy(&trial.pipeline);
    glint_replay_destroy(&trial.replay);
    return trial.ok;
}
