/* What a sweep is, and what it has found, on disk: an interrupted one goes on from there. */
#include "sweep.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text_file.h"

bool sweep_path(const struct sweep *sweep, const char *name, char path[4096], struct glint_error *err) {
    return snprintf(path, 4096, "%s/%s", sweep->out, name) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", sweep->out);
}

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static json_t *strings(const char *const *items) {
    json_t *list = json_array();
    for (; items && *items; items++) json_array_append_new(list, json_string(*items));
    return list;
}

static json_t *pipeline_json(const struct glint_pipeline *pipeline) {
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

/* The users' shaders themselves: a file that was changed is another sweep. */
static json_t *shaders_json(const struct list *shaders, struct glint_error *err) {
    json_t *object = json_object();
    for (size_t i = 0; i < shaders->count; i++) {
        const char *path = strchr(shaders->items[i], '=') + 1;
        FILE *file = fopen(path, "rb");
        char *text = calloc(1, 1 << 20);
        if (!file || !text) {
            glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
            json_decref(object);
            object = NULL;
        } else if (fread(text, 1, (1 << 20) - 1, file) > 0)
            json_object_set_new(object, shaders->items[i], json_string(text));
        if (file) fclose(file);
        free(text);
        if (!object) return NULL;
    }
    return object;
}

static json_t *captures_json(const struct sweep *sweep, struct glint_error *err) {
    json_t *list = json_array();
    for (size_t i = 0; i < sweep->captures.count; i++) {
        char hash[33];
        struct glint_capture *capture = glint_capture_open(sweep->captures.items[i], NULL, err);
        const bool ok = capture && glint_capture_hash(capture, hash, err);
        if (capture) glint_capture_close(&capture);
        if (!ok) {
            json_decref(list);
            return NULL;
        }
        json_array_append_new(list, json_string(hash));
    }
    return list;
}

/* All that the results depend on. */
static json_t *define(const struct sweep *sweep, const char *const *axes, const char *sample,
                      const struct list *shaders, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(sweep->device);
    json_t *captures = captures_json(sweep, err), *sources = captures ? shaders_json(shaders, err) : NULL;
    if (!sources) {
        json_decref(captures);
        return NULL;
    }
    json_t *json =
        json_pack("{s:i, s:s, s:o, s:o, s:o, s:o, s:s, s:s, s:o, s:I, s:I, s:b, s:b, s:I, s:[ss]}", "format", 1,
                  "glint", GLINT_VERSION, "captures", captures, "pipeline", pipeline_json(sweep->base), "shaders",
                  sources, "vary", strings(axes), "sample", sample, "reference", sweep->truth ? "truth" : "computed",
                  "reference_runs", strings(sweep->references.items), "reference_rays", (json_int_t)sweep->rays,
                  "repeat", (json_int_t)sweep->rounds, "whole", sweep->whole, "all", sweep->all, "metrics",
                  (json_int_t)sweep->metrics, "device", device->name, device->driver_version);
    if (!json) no_memory(err);
    return json;
}

static bool same_definition(const struct sweep *sweep, const json_t *theirs, const json_t *ours,
                            struct glint_error *err) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)ours, key, value) {
        const json_t *other = json_object_get(theirs, key);
        if (json_equal(other, value)) continue;
        char *found = other ? json_dumps(other, JSON_ENCODE_ANY | JSON_COMPACT) : NULL;
        char *expected = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT);
        glint_fail(
            err, GLINT_ERROR_USAGE,
            "%s: holds a sweep with another %s: it has %.300s, this command %.300s; repeat its arguments, or choose "
            "another folder",
            sweep->out, key, found ? found : "none", expected ? expected : "?");
        free(found);
        free(expected);
        return false;
    }
    return true;
}

/* Puts a line into its row; false when it is none of this sweep's. */
static bool keep(struct sweep *sweep, json_t *line) {
    const json_t *c = json_object_get(line, "capture"), *p = json_object_get(line, "point"),
                 *r = json_object_get(line, "round");
    if (!json_is_integer(c) || !json_is_integer(p)) return false;
    const json_int_t capture = json_integer_value(c), point = json_integer_value(p), round = json_integer_value(r);
    if (capture < 0 || capture >= (json_int_t)sweep->captures.count || point < 0 ||
        point >= (json_int_t)sweep->points ||
        (r && (!json_is_integer(r) || round < 0 || round >= (json_int_t)sweep->rounds)))
        return false;
    struct sweep_row *row = sweep_row(sweep, (size_t)capture, (size_t)point);
    json_t **place = r ? &row->rounds[round] : &row->look;
    json_decref(*place);
    *place = json_incref(line);
    return true;
}

/* Reads whole lines; what an end without warning left of another is cut off. */
static bool read_log(struct sweep *sweep, const char *path, struct glint_error *err) {
    FILE *file = fdopen(dup(sweep->log), "rb");
    char *line = NULL;
    size_t size = 0;
    off_t whole = 0;
    bool ok = file != NULL || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    for (ssize_t length; ok && (length = getline(&line, &size, file)) > 0 && line[length - 1] == '\n';
         whole += length) {
        json_error_t error;
        json_t *json = json_loads(line, 0, &error);
        if (!json || !keep(sweep, json))
            ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: byte %lld: expected a line of this sweep, found '%.80s'",
                            path, (long long)whole, line);
        json_decref(json);
    }
    free(line);
    if (file) fclose(file);
    if (ok && ftruncate(sweep->log, whole) != 0) ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    return ok;
}

static bool make_rows(struct sweep *sweep, struct glint_error *err) {
    const size_t rows = sweep->captures.count * sweep->points;
    sweep->rows = calloc(rows + 1, sizeof *sweep->rows);
    for (size_t i = 0; sweep->rows && i < rows; i++)
        if (!(sweep->rows[i].rounds = calloc(sweep->rounds + 1, sizeof(json_t *)))) return no_memory(err);
    return sweep->rows || no_memory(err);
}

static bool write_definition(const struct sweep *sweep, const char *path, struct glint_error *err) {
    char *text = json_dumps(sweep->definition, JSON_INDENT(1));
    const bool ok = text ? text_file_write(path, text, err) : no_memory(err);
    free(text);
    return ok;
}

bool sweep_open(struct sweep *sweep, const char *const *axes, const char *sample, const struct list *shaders,
                struct glint_error *err) {
    char path[4096];
    json_error_t error;
    if (!make_rows(sweep, err) || !(sweep->definition = define(sweep, axes, sample, shaders, err)) ||
        !sweep_path(sweep, "sweep.json", path, err))
        return false;
    if (mkdir(sweep->out, 0777) != 0 && errno != EEXIST)
        return glint_fail(err, GLINT_ERROR_IO, "%s: %s", sweep->out, strerror(errno));
    if (access(path, F_OK) == 0) {
        json_t *theirs = json_load_file(path, 0, &error);
        bool ok = theirs ? same_definition(sweep, theirs, sweep->definition, err)
                         : glint_fail(err, GLINT_ERROR_FORMAT, "%s: line %d: %s", path, error.line, error.text);
        json_decref(theirs);
        if (!ok) return false;
    } else if (!write_definition(sweep, path, err)) return false;
    if (!sweep_path(sweep, "log.jsonl", path, err)) return false;
    sweep->log = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (sweep->log < 0) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    if (lockf(sweep->log, F_TLOCK, 0) != 0)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: another sweep is at work in this folder", sweep->out);
    return read_log(sweep, path, err);
}

bool sweep_append(struct sweep *sweep, json_t *line, struct glint_error *err) {
    char *text = line ? json_dumps(line, JSON_COMPACT) : NULL;
    const size_t length = text ? strlen(text) : 0;
    bool ok = text || no_memory(err);
    if (ok) text[length] = '\n'; /* in the place of the end: one write of a whole line */
    if (ok && write(sweep->log, text, length + 1) != (ssize_t)(length + 1))
        ok = glint_fail(err, GLINT_ERROR_IO, "%s/log.jsonl: %s", sweep->out, strerror(errno));
    if (ok) keep(sweep, line);
    free(text);
    json_decref(line);
    return ok;
}

void sweep_finish(struct sweep *sweep) {
    for (size_t i = 0; sweep->rows && i < sweep->captures.count * sweep->points; i++) {
        json_decref(sweep->rows[i].look);
        for (uint32_t r = 0; sweep->rows[i].rounds && r < sweep->rounds; r++) json_decref(sweep->rows[i].rounds[r]);
        free(sweep->rows[i].rounds);
    }
    free(sweep->rows);
    for (size_t f = 0; f < sweep->front_count; f++) {
        free(sweep->fronts[f].on);
        free(sweep->fronts[f].points);
    }
    free(sweep->sums);
    json_decref(sweep->definition);
    if (sweep->log > 0) close(sweep->log);
    if (sweep->space) glint_space_destroy(&sweep->space);
    if (sweep->base) glint_pipeline_destroy(&sweep->base);
    list_free(&sweep->captures);
    list_free(&sweep->references);
}

char *sweep_point_text(const struct sweep *sweep, size_t point) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (size_t a = 0; out && a < glint_space_axis_count(sweep->space); a++) {
        const char *value = glint_space_value(sweep->space, point, a);
        if (value[0]) fprintf(out, "%s%s=%s", ftell(out) > 0 ? " " : "", glint_space_axis(sweep->space, a), value);
    }
    if (out) fclose(out);
    return text;
}
