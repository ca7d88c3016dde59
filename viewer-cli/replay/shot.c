/* Replays several captures into one folder and keeps frames that an interrupted replay completed. */
#include "replay/shot.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/declarations.h"
#include "io/output.h"
#include "journal/journal.h"
#include "record.h"

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

/* What memory or the system refused says nothing about a file. */
static bool is_refusal(const struct glint_error *err) {
    return err->code == GLINT_ERROR_MEMORY || err->code == GLINT_ERROR_IO;
}

/* The settings that are stored; NULL with no error set if there are none. */
static json_t *read_settings(const char *path, struct glint_error *err) {
    struct glint_error why = {0};
    if (access(path, F_OK) != 0 && errno == ENOENT) return NULL;
    json_t *settings = json_inside(path, &why);
    if (!settings && is_refusal(&why)) *err = why;
    return settings;
}

json_t *shot_settings(const struct glint_pipeline *pipeline, const struct pipeline_args *args, const char *device,
                      struct glint_error *err) {
    const struct glint_replay_options *o = &args->replay;
    json_t *shaders = shaders_json(&args->shader, err);
    if (!shaders) return NULL;
    return json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:s?, s:s?, s:b, s:b, s:b}", "tool", GLINT_VERSION,
                     "device", device, "pipeline", passes_json(pipeline), "shaders", shaders, "passes",
                     names_json(&args->passes), "outputs", names_json(&args->outputs), "skip", names_json(&args->skip),
                     "force", names_json(&args->force), "inputs", o->inputs, "history", o->history, "all", o->all,
                     "diagnostics", o->diagnostics, "float", o->float_precision);
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
    char *text = record_text(settings, JSON_INDENT(1) | JSON_SORT_KEYS);
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
    char *text = record_text(settings, 0);
    json_t *before = read_settings(path, err), *now = text ? json_loads(text, 0, NULL) : NULL;
    bool same = now && json_equal(before, now), ok = !err->code && (now || fail_memory(err));
    json_decref(before);
    json_decref(now);
    free(text);
    for (size_t i = 0; !same && ok && i < count; i++) ok = glint_run_remove(runs[i], err);
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

bool shot_has(const char *run, const char *capture, bool *has, struct glint_error *err) {
    char hash[33], path[4096];
    struct glint_error why = {0};
    *has = false;
    if (snprintf(path, sizeof path, "%s/run.json", run) >= (int)sizeof path || access(path, F_OK) != 0) return true;
    struct glint_run *opened = glint_run_open(run, &why);
    json_t *record = opened ? json_loads(glint_run_json(opened), 0, NULL) : NULL;
    const char *made_of = json_string_value(json_object_get(json_object_get(record, "capture"), "xxh3_128"));
    struct glint_capture *now = made_of ? glint_capture_open(capture, NULL, &why) : NULL;
    *has = now && files_are_there(run, record) && glint_capture_hash(now, hash, &why) && !strcmp(hash, made_of);
    if (opened && !record) fail_memory(&why);
    glint_capture_close(&now);
    json_decref(record);
    glint_run_close(&opened);
    return *has || !is_refusal(&why) || glint_fail(err, why.code, "%s", why.message);
}

bool shot_follows(const char *run, const char *capture, bool *follows, struct glint_error *err) {
    struct glint_error why = {0};
    struct glint_run *before = glint_run_open(run, &why);
    struct glint_capture *now = before ? glint_capture_open(capture, NULL, &why) : NULL;
    json_t *record = now ? json_loads(glint_run_json(before), 0, NULL) : NULL;
    const json_t *frame = json_object_get(record, "frame");
    *follows = json_is_integer(frame) && json_integer_value(frame) + 1 == glint_capture_frame(now)->number;
    if (now && !record) fail_memory(&why);
    json_decref(record);
    glint_capture_close(&now);
    glint_run_close(&before);
    return !is_refusal(&why) || glint_fail(err, why.code, "%s", why.message);
}
