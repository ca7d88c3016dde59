/* Reads presets: JSON files by path or in $GLINT_PRESETS, and the built-in ones. */
#include "pipeline.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <jansson.h>

#include "faults.h"
#include "text_file.h"

struct builtin_preset {
    const char *name, *text;
};
#include "builtin_presets.h"
#include "nearest.h"
enum { PATH_SIZE = 4096, BUILTIN = sizeof builtin_presets / sizeof builtin_presets[0] };

const char *glint_preset(size_t i) {
    return i < BUILTIN ? builtin_presets[i].name : NULL;
}

/* The JSON text of a preset, which the caller frees. `where` receives its path or name for messages. */
static char *preset_text(const char *preset, char where[PATH_SIZE], struct glint_error *err) {
    enum { LIMIT = 1 << 20 };
    const size_t length = strlen(preset);
    const char *folder = getenv("GLINT_PRESETS");
    struct glint_nearest near = glint_nearest_to(preset);
    const bool is_path = strchr(preset, '/') || (length > 5 && strcmp(preset + length - 5, ".json") == 0);
    if (!is_path && folder && folder[0] && snprintf(where, PATH_SIZE, "%s/%s.json", folder, preset) < PATH_SIZE &&
        access(where, F_OK) == 0)
        return file_text_found(where, LIMIT, err);
    snprintf(where, PATH_SIZE, "%s", preset);
    if (is_path) return file_text(preset, LIMIT, err);
    for (size_t i = 0; i < BUILTIN; i++) {
        if (strcmp(builtin_presets[i].name, preset) == 0) {
            char *text = strdup(builtin_presets[i].text);
            if (!text) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
            return text;
        }
        glint_nearest_offer(&near, builtin_presets[i].name);
    }
    glint_fail(err, GLINT_ERROR_USAGE, "unknown preset '%s'%s; built in: %s; others by path or in $GLINT_PRESETS",
               preset, glint_nearest_text(&near), near.known);
    return NULL;
}

/* "set": {"slot.parameter": value} */
static bool apply_set(struct glint_pipeline *pipeline, const char *key, const json_t *value, struct glint_error *err) {
    char number[64], assignment[512];
    const char *text = number;
    if (json_is_string(value)) text = json_string_value(value);
    else if (json_is_boolean(value)) text = json_is_true(value) ? "1" : "0";
    else if (json_is_number(value)) snprintf(number, sizeof number, "%.17g", json_number_value(value));
    else return glint_fail(err, GLINT_ERROR_USAGE, "set: %s: expected a number, true, false or a name", key);
    if (snprintf(assignment, sizeof assignment, "%s=%s", key, text) >= (int)sizeof assignment)
        return glint_fail(err, GLINT_ERROR_USAGE, "set: %s: expected a shorter value", key);
    return glint_pipeline_set(pipeline, assignment, err);
}

static void apply_preset(struct glint_pipeline *pipeline, json_t *root, struct faults *faults) {
    const char *key;
    json_t *value, *slots = json_object_get(root, "slots"), *set = json_object_get(root, "set");
    struct glint_error one;
    if (!json_is_object(root)) {
        faults_add(faults, GLINT_ERROR_FORMAT, "expected an object");
        return;
    }
    json_object_foreach(root, key, value) {
        bool text = strcmp(key, "name") == 0 || strcmp(key, "title") == 0 || strcmp(key, "source") == 0;
        /* provenance documents how a tuned preset was made and is ignored here */
        bool object = strcmp(key, "slots") == 0 || strcmp(key, "set") == 0 || strcmp(key, "provenance") == 0;
        if (!text && !object)
            faults_add(faults, GLINT_ERROR_FORMAT,
                       "unknown key '%s'; known: name, title, source, slots, set, provenance", key);
        else if (text ? !json_is_string(value) : !json_is_object(value))
            faults_add(faults, GLINT_ERROR_FORMAT, "%s: expected %s", key, text ? "a string" : "an object");
    }
    if (!slots) faults_add(faults, GLINT_ERROR_FORMAT, "expected 'slots'");
    json_object_foreach(slots, key, value) if (!json_is_string(value))
        faults_add(faults, GLINT_ERROR_FORMAT, "slots: %s: expected the name of a variant", key);
    else if (!pipeline_use(pipeline, key, json_string_value(value), &one))
        faults_add(faults, one.code, "%s", one.message);
    json_object_foreach(set, key, value) if (!apply_set(pipeline, key, value, &one))
        faults_add(faults, one.code, "%s", one.message);
}

struct glint_pipeline *glint_pipeline_create(const char *preset, struct glint_error *err) {
    char where[PATH_SIZE], *text = preset_text(preset, where, err);
    struct glint_pipeline *pipeline = text ? calloc(1, sizeof *pipeline) : NULL;
    json_error_t fault;
    json_t *root = text ? json_loads(text, JSON_REJECT_DUPLICATES, &fault) : NULL;
    const char *name = json_string_value(json_object_get(root, "name"));
    struct faults faults = {0};
    bool ok = text && (pipeline || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory"));
    if (ok && !root)
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s:%d:%d: %s", where, fault.line, fault.column, fault.text);
    if (ok && !(pipeline->name = strdup(name ? name : preset)))
        ok = glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) apply_preset(pipeline, root, &faults);
    ok = ok && faults_none(&faults, where, err);
    json_decref(root);
    free(text);
    if (!ok) glint_pipeline_destroy(&pipeline);
    return pipeline;
}
