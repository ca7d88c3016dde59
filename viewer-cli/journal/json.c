/* JSON of pipelines, captures, errors and costs in studies. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "inside.h"
#include "journal/journal.h"
#include "options/capture_set.h"

json_t *json_inside(const char *path, struct glint_error *err) {
    enum { MOST_BYTES = 1 << 24 };
    json_error_t fault;
    char *text = inside_text(path, MOST_BYTES, err);
    const bool fits = text && inside_json_fits(path, text, strlen(text), err);
    json_t *json = fits ? json_loads(text, JSON_REJECT_DUPLICATES, &fault) : NULL;
    if (fits && !json) glint_fail(err, GLINT_ERROR_FORMAT, "%s: line %d: %s", path, fault.line, fault.text);
    free(text);
    return json;
}

json_t *strings_json(const char *const *items) {
    json_t *list = json_array();
    for (; items && *items; items++) json_array_append_new(list, json_string(*items));
    return list;
}

json_t *pipeline_json(const struct glint_pipeline *pipeline) {
    json_t *slots = json_object();
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        json_t *values = json_object();
        for (size_t r = 0; r < pass->row_count; r++) {
            const enum glint_row_kind kind = pass->rows[r].kind;
            if (kind == GLINT_ROW_SPEC || kind == GLINT_ROW_CHOICE || kind == GLINT_ROW_PUSH)
                json_object_set_new(values, pass->rows[r].name,
                                    json_real(glint_pipeline_value(pipeline, pass, &pass->rows[r])));
        }
        json_object_set_new(slots, pass->slot, json_pack("{s:s, s:o}", "variant", pass->variant, "values", values));
    }
    return json_pack("{s:s, s:I, s:o}", "preset", glint_pipeline_name(pipeline), "rays",
                     (json_int_t)glint_pipeline_rays(pipeline), "slots", slots);
}

json_t *shaders_json(const struct list *shaders, struct glint_error *err) {
    json_t *object = json_object();
    for (size_t i = 0; i < shaders->count; i++) {
        const char *path = strchr(shaders->items[i], '=') + 1;
        FILE *file = fopen(path, "rb");
        char *text = calloc(1, 1 << 20);
        const bool any = file && text && fread(text, 1, (1 << 20) - 1, file) > 0;
        if (!file || !text || ferror(file)) {
            glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
            json_decref(object);
            object = NULL;
        } else if (any) json_object_set_new(object, shaders->items[i], json_string(text));
        if (file) fclose(file);
        free(text);
        if (!object) return NULL;
    }
    return object;
}

json_t *captures_json(const struct list *captures, bool lenient, struct glint_error *err) {
    json_t *list = json_array();
    for (size_t i = 0; i < captures->count; i++) {
        char hash[33];
        *err = (struct glint_error){0};
        if (lenient && capture_set_hash(captures, i)) {
            json_array_append_new(list, json_string(capture_set_hash(captures, i)));
            continue;
        }
        struct glint_capture *capture = glint_capture_open(captures->items[i], NULL, err);
        const bool ok = capture && glint_capture_hash(capture, hash, err) && capture_set_check(captures, i, hash, err);
        if (capture) glint_capture_close(&capture);
        if (!ok && (!lenient || err->code == GLINT_ERROR_MEMORY)) {
            json_decref(list);
            return NULL;
        }
        json_array_append_new(list, ok ? json_string(hash) : json_pack("{s:s}", "failed", err->message));
    }
    *err = (struct glint_error){0};
    return list;
}

json_t *errors_json(const struct glint_metric_table *table, uint32_t metrics) {
    json_t *classes = json_object();
    for (size_t i = 0; i < table->count; i++) {
        const struct glint_metric_row *row = &table->rows[i];
        json_t *figures = json_pack("{s:I}", "pixels", (json_int_t)row->pixels);
        for (size_t m = 0; m < GLINT_METRIC_COUNT && row->pixels; m++)
            if (metrics >> m & 1) json_object_set_new(figures, glint_metric(m)->name, json_number(row->of[m].value));
        json_object_set_new(classes, row->name, figures);
    }
    return classes;
}

json_t *cost_json(const struct glint_cost *cost, uint32_t round) {
    json_t *passes = json_object();
    for (size_t i = 0; i < cost->pass_count; i++)
        json_object_set_new(passes, cost->passes[i].pass->slot, json_real((double)cost->passes[i].ns * 1e-6));
    return json_pack("{s:I, s:f, s:f, s:o}", "round", (json_int_t)round, "frame_ms", (double)cost->frame_ns * 1e-6,
                     "cubemaps_ms", (double)cost->cubemaps_ns * 1e-6, "passes", passes);
}
