/* Replays several captures into one folder and keeps frames that an interrupted replay completed. */
#include "replay/shot.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/declarations.h"
#include "io/output.h"
#include "shown.h"

static json_t *names_json(const struct list *list) {
    json_t *names = json_array();
    for (size_t i = 0; i < list->count; i++) json_array_append_new(names, json_string(list->items[i]));
    return names;
}

static json_t *passes_json(const struct glint_pipeline *pipeline) {
    json_t *passes = json_array();
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        json_t *values = json_array(); /* by row: 0 where a row is no parameter */
        for (size_t r = 0; r < pass->row_count; r++)
            json_array_append_new(values, json_real(glint_pipeline_value(pipeline, pass, &pass->rows[r])));
        json_array_append_new(
            passes, json_pack("{s:s, s:s, s:o}", "slot", pass->slot, "variant", pass->variant, "values", values));
    }
    return passes;
}

/* Texts of the user's shader files. */
static json_t *shaders_json(const struct list *shaders) {
    json_t *texts = json_object();
    for (size_t i = 0; i < shaders->count; i++) {
        const char *path = strchr(shaders->items[i], '=');
        FILE *file = path ? fopen(path + 1, "rb") : NULL;
        char *text = NULL;
        size_t size = 0;
        if (file && getdelim(&text, &size, '\0', file) > 0)
            json_object_set_new(texts, shaders->items[i], json_string(text));
        free(text);
        if (file) fclose(file);
    }
    return texts;
}

json_t *shot_settings(const struct glint_pipeline *pipeline, const struct pipeline_args *args, const char *device) {
    const struct glint_replay_options *o = &args->replay;
    return json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:s?, s:s?, s:b, s:b, s:b}", "tool", GLINT_VERSION,
                     "device", device, "pipeline", passes_json(pipeline), "shaders", shaders_json(&args->shader),
                     "passes", names_json(&args->passes), "outputs", names_json(&args->outputs), "skip",
                     names_json(&args->skip), "force", names_json(&args->force), "inputs", o->inputs, "history",
                     o->history, "all", o->all, "diagnostics", o->diagnostics, "float", o->float_precision);
}

/* An image that a pass of the pipeline writes. */
static void add_output(struct list *outputs, const struct glint_pipeline *pipeline, const char *image) {
    bool made = false;
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++)
        made |= glint_pass_output(glint_pipeline_pass(pipeline, i), image) != NULL;
    for (size_t i = 0; i < outputs->count; i++)
        if (!strcmp(outputs->items[i], image)) made = false;
    if (made) list_add(outputs, image, NULL);
}

void shot_keep_history(struct list *outputs, const struct glint_pipeline *pipeline) {
    for (size_t i = 0; outputs->count && i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        for (size_t r = 0; r < pass->row_count; r++) {
            if (pass->rows[r].kind != GLINT_ROW_HISTORY) continue;
            add_output(outputs, pipeline, pass->rows[r].image);
            const struct glint_row *bypass = glint_pass_row(pass, GLINT_ROW_BYPASS, pass->rows[r].image);
            if (bypass) add_output(outputs, pipeline, bypass->name); /* has its place where the pass is dropped */
        }
    }
}

static bool write_settings(const char *path, const json_t *settings, struct glint_error *err) {
    char *text = shown_json(json_dumps(settings, JSON_INDENT(1) | JSON_SORT_KEYS));
    bool ok = text ? output_text(path, text, err) : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    free(text);
    return ok;
}

bool shot_begin(const char *folder, const json_t *settings, char *const *runs, size_t count, struct glint_error *err) {
    char path[4096];
    if (!glint_make_folder(folder, err)) return false;
    if (snprintf(path, sizeof path, "%s/shot.json", folder) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    /* What is compared went through a file once, as the other did. */
    char *text = shown_json(json_dumps(settings, 0));
    json_t *before = json_load_file(path, 0, NULL), *now = text ? json_loads(text, 0, NULL) : NULL;
    bool same = now && json_equal(before, now), ok = true;
    json_decref(before);
    json_decref(now);
    free(text);
    for (size_t i = 0; !same && ok && i < count; i++) {
        char record[4096];
        if (snprintf(record, sizeof record, "%s/run.json", runs[i]) >= (int)sizeof record) continue;
        ok = unlink(record) == 0 || errno == ENOENT || errno == ENOTDIR ||
             glint_fail(err, GLINT_ERROR_IO, "%s: %s", record, strerror(errno));
    }
    return ok && (same || write_settings(path, settings, err));
}

static bool files_are_there(const char *run, const json_t *record) {
    const json_t *pass, *image;
    size_t p, i;
    json_array_foreach(json_object_get(record, "passes"), p, pass) {
        json_array_foreach(json_object_get(pass, "images"), i, image) {
            const char *file = json_string_value(json_object_get(image, "file"));
            char path[4096];
            if (!file || snprintf(path, sizeof path, "%s/%s", run, file) >= (int)sizeof path || access(path, R_OK) != 0)
                return false;
        }
    }
    return true;
}

bool shot_has(const char *run, const char *capture) {
    char hash[33];
    struct glint_run *opened = glint_run_open(run, NULL);
    json_t *record = opened ? json_loads(glint_run_json(opened), 0, NULL) : NULL;
    const char *made_of = json_string_value(json_object_get(json_object_get(record, "capture"), "xxh3_128"));
    struct glint_capture *now = made_of ? glint_capture_open(capture, NULL, NULL) : NULL;
    bool has = now && files_are_there(run, record) && glint_capture_hash(now, hash, NULL) && !strcmp(hash, made_of);
    glint_capture_close(&now);
    json_decref(record);
    glint_run_close(&opened);
    return has;
}

bool shot_follows(const char *run, const char *capture) {
    struct glint_run *before = glint_run_open(run, NULL);
    struct glint_capture *now = glint_capture_open(capture, NULL, NULL);
    json_t *record = before ? json_loads(glint_run_json(before), 0, NULL) : NULL;
    const json_t *frame = json_object_get(record, "frame");
    bool follows = now && json_is_integer(frame) && json_integer_value(frame) + 1 == glint_capture_frame(now)->number;
    json_decref(record);
    glint_capture_close(&now);
    glint_run_close(&before);
    return follows;
}
