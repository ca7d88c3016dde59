/* Reads back from run.json what a run was made of. */
#include <jansson.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "options/run_source.h"

/* A file or folder that the run names: relative to the current folder, or beside the run. */
static bool find_file(char out[4096], const char *folder, const json_t *name, struct glint_error *err) {
    const char *path = json_string_value(name);
    *out = '\0';
    if (!path) return true;
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/') length--;
    while (length > 0 && folder[length - 1] != '/') length--;
    if (access(path, R_OK) != 0 && path[0] != '/' && length > 0) {
        const int beside = snprintf(out, 4096, "%.*s%s", (int)length, folder, path);
        if (beside > 0 && beside < 4096 && access(out, R_OK) == 0) return true;
    }
    return snprintf(out, 4096, "%s", path) < 4096 ||
           glint_fail(err, GLINT_ERROR_FORMAT, "%s/run.json: it names a path that is too long", folder);
}

/* "slot.parameter=value" of one member of "parameters". */
static bool set_parameter(struct glint_pipeline *pipeline, const char *slot, const char *name, const json_t *value,
                          struct glint_error *err) {
    char assignment[300];
    int length;
    if (json_is_string(value))
        length = snprintf(assignment, sizeof assignment, "%s.%s=%s", slot, name, json_string_value(value));
    else if (json_is_boolean(value))
        length =
            snprintf(assignment, sizeof assignment, "%s.%s=%s", slot, name, json_is_true(value) ? "true" : "false");
    else length = snprintf(assignment, sizeof assignment, "%s.%s=%.17g", slot, name, json_number_value(value));
    if (length < 0 || length >= (int)sizeof assignment)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s.%s: the value is too long", slot, name);
    return glint_pipeline_set(pipeline, assignment, err);
}

static const json_t *pass_of(const json_t *passes, const char *slot) {
    size_t i;
    const json_t *pass;
    json_array_foreach(passes, i, pass) {
        const char *name = json_string_value(json_object_get(pass, "slot"));
        if (name && !strcmp(name, slot)) return pass;
    }
    return NULL;
}

/* Removes the slots that the run does not have. */
static bool remove_others(struct glint_pipeline *pipeline, const json_t *passes, struct glint_error *err) {
    for (size_t i = glint_pipeline_pass_count(pipeline); i-- > 0;) {
        const char *slot = glint_pipeline_pass(pipeline, i)->slot;
        char assignment[200];
        snprintf(assignment, sizeof assignment, "%s=none", slot);
        if (!pass_of(passes, slot) && !glint_pipeline_use(pipeline, assignment, err)) return false;
    }
    return true;
}

static bool use_passes(struct glint_pipeline *pipeline, const json_t *passes, struct glint_error *err) {
    size_t i;
    const json_t *pass;
    json_array_foreach(passes, i, pass) {
        const char *slot = json_string_value(json_object_get(pass, "slot"));
        const char *variant = json_string_value(json_object_get(pass, "variant"));
        char assignment[200];
        if (!slot || !variant ||
            snprintf(assignment, sizeof assignment, "%s=%s", slot, variant) >= (int)sizeof assignment)
            return glint_fail(err, GLINT_ERROR_FORMAT, "pass %zu: expected a slot and a variant", i);
        if (!glint_pipeline_use(pipeline, assignment, err)) return false;
    }
    return remove_others(pipeline, passes, err);
}

static bool set_parameters(struct glint_pipeline *pipeline, const json_t *passes, struct glint_error *err) {
    size_t i;
    json_t *pass, *value;
    const char *name;
    json_array_foreach(passes, i, pass) {
        json_object_foreach(json_object_get(pass, "parameters"), name, value) {
            if (!set_parameter(pipeline, json_string_value(json_object_get(pass, "slot")), name, value, err))
                return false;
        }
    }
    return true;
}

static bool set_rays(struct glint_pipeline *pipeline, const json_t *run, struct glint_error *err) {
    const json_t *rays = json_object_get(run, "rays"), *first = json_object_get(run, "first_ray");
    return (!rays || set_parameter(pipeline, "pipeline", "rays", rays, err)) &&
           (!first || set_parameter(pipeline, "pipeline", "first_ray", first, err));
}

/* The preset of that name, if it is still there, gives the pipeline its name; variants and values are the run's. */
static struct glint_pipeline *rebuild(const json_t *run, struct glint_error *err) {
    const char *preset = json_string_value(json_object_get(run, "preset"));
    const json_t *passes = json_object_get(run, "passes");
    struct glint_pipeline *pipeline = preset ? glint_pipeline_create(preset, NULL) : NULL;
    if (!pipeline) pipeline = glint_pipeline_create(glint_preset(0), err);
    if (pipeline &&
        !(use_passes(pipeline, passes, err) && set_parameters(pipeline, passes, err) && set_rays(pipeline, run, err)))
        glint_pipeline_destroy(&pipeline);
    return pipeline;
}

bool run_source_read(struct run_source *source, const char *folder, struct glint_error *err) {
    *source = (struct run_source){0};
    struct glint_run *run = glint_run_open(folder, err);
    json_t *json = run ? json_loads(glint_run_json(run), 0, NULL) : NULL;
    const json_t *capture = json_object_get(json, "capture");
    const char *hash = json_string_value(json_object_get(capture, "xxh3_128"));
    const char *precision = json_string_value(json_object_get(json, "precision"));
    struct glint_error cause = {0};
    bool ok = json && find_file(source->capture, folder, json_object_get(capture, "path"), err) &&
              find_file(source->history, folder, json_object_get(json, "history"), err) &&
              find_file(source->inputs, folder, json_object_get(json, "inputs"), err);
    if (ok && !source->capture[0])
        ok = glint_fail(err, GLINT_ERROR_FORMAT,
                        "%s/run.json: capture.path: expected a path, found none, as where the path was not UTF-8",
                        folder);
    if (ok && !(source->pipeline = rebuild(json, &cause)))
        ok = glint_fail(err, cause.code, "%s/run.json: %s", folder, cause.message);
    source->all = json_is_true(json_object_get(json, "all"));
    source->float_precision = precision && !strcmp(precision, "float");
    snprintf(source->hash, sizeof source->hash, "%s", hash ? hash : "");
    json_decref(json);
    glint_run_close(&run);
    return ok;
}

bool run_source_fits(const struct run_source *source, const char *folder, struct glint_capture *capture,
                     struct glint_error *err) {
    char hash[33];
    if (!source->hash[0]) return true;
    if (!glint_capture_hash(capture, hash, err)) return false;
    return strcmp(hash, source->hash) == 0 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: not the capture that %s was made of (XXH3 %s, expected %s)",
                      glint_capture_path(capture), folder, hash, source->hash);
}

void run_source_finish(struct run_source *source) {
    if (source->pipeline) glint_pipeline_destroy(&source->pipeline);
}
