/* The reflection of a run, the capture's truth, the class of each pixel's surface, the reference of a pipeline. */
#include "glint/study.h"
#include "question.h"
#include "values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

static bool composes(const struct glint_pass *pass) {
    return pass && glint_pass_role(pass, GLINT_ROLE_COMPOSED);
}

uint8_t *glint_study_surfaces(struct glint_capture *capture, struct glint_error *err) {
    static const char *const channels[] = {"depth.Z", "material.roughness", "material.metalness", "material.specular"};
    float *values = study_channels(capture, GLINT_PART_GBUFFER, channels, 4, err);
    if (!values) return NULL;
    const struct glint_part_info *part = glint_capture_find(capture, GLINT_PART_GBUFFER);
    const size_t pixels = (size_t)part->width * part->height;
    uint8_t *surfaces = calloc(pixels, 1);
    if (!surfaces) glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    for (size_t i = 0; surfaces && i < pixels; i++) {
        const float *v = values + 4 * i;
        if (v[0] < INFINITY && (v[2] > 0 || v[3] > 0)) surfaces[i] = (uint8_t)glint_surface_of((double)v[1]);
    }
    free(values);
    return surfaces;
}

/* Only images that the composer reads count, if the run has it: water and glass are composed afterwards, and images that only they read are not
   reflections in the opaque surfaces. */
const struct glint_image *glint_study_reflection_image(struct glint_replay *replay) {
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    const struct glint_image *last = NULL;
    const struct glint_pass *composer = NULL;
    for (size_t i = 0; i < count; i++)
        if (results[i].shown && composes(results[i].pass)) composer = results[i].pass;
    for (size_t i = 0; i < count; i++) {
        const struct glint_image *image =
            results[i].ran && results[i].pass != composer ? study_radiance(replay, results[i].pass, composer) : NULL;
        if (image) last = image;
    }
    return last;
}

bool glint_study_reflection(struct glint_replay *replay, struct glint_pixels *pixels, struct glint_error *err) {
    const struct glint_image *last = glint_study_reflection_image(replay);
    *pixels = (struct glint_pixels){0};
    if (!last) return glint_fail(err, GLINT_ERROR_USAGE, "the run has no reflection at full resolution to compare");
    *pixels = (struct glint_pixels){last->width, last->height, last->components, NULL};
    return (pixels->values = study_values(replay, last, GLINT_F32, err)) != NULL;
}

const struct glint_run_image *glint_study_run_reflection_image(const struct glint_run *run) {
    const struct glint_run_image *last = NULL;
    const struct glint_pass *composer = NULL;
    uint32_t widest = 0;
    for (size_t i = 0; i < glint_run_image_count(run); i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        const struct glint_pass *pass = glint_pass_find(image->slot, image->variant);
        if (composes(pass)) composer = pass;
    }
    for (size_t i = 0; i < glint_run_image_count(run); i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        if (strcmp(image->unit, "radiance") || (composer && !strcmp(image->slot, composer->slot)) || image->integer)
            continue;
        if (image->cube || image->width < widest) continue; /* cubes; half resolution */
        if (composer && !glint_pass_row(composer, GLINT_ROW_READ, image->name)) continue;
        widest = image->width;
        last = image;
    }
    return last;
}

bool glint_study_run_reflection(struct glint_run *run, struct glint_pixels *pixels, struct glint_error *err) {
    const struct glint_run_image *last = glint_study_run_reflection_image(run);
    *pixels = (struct glint_pixels){0};
    if (!last) return glint_fail(err, GLINT_ERROR_USAGE, "the run has no reflection to compare with");
    *pixels = (struct glint_pixels){last->width, last->height, last->components, NULL};
    return (pixels->values = study_run_values(run, last, err)) != NULL;
}

/* The value of a parameter as text for glint_pipeline_set; false if the pipeline has no such parameter. */
static bool parameter_text(const struct glint_pipeline *pipeline, const char *slot, const char *name, char text[64]) {
    const struct glint_pass *pass = glint_pipeline_find(pipeline, slot);
    const struct glint_row *row = pass ? glint_pass_parameter(pass, name) : NULL;
    if (!row) return false;
    const double value = glint_pipeline_value(pipeline, pass, row);
    if (row->choices) snprintf(text, 64, "%s", row->choices[(size_t)value]);
    else snprintf(text, 64, "%.17g", value);
    return true;
}

/* The i-th row with role DEFINES_RESULT among the pipeline's passes; NULL past the last. */
static const struct glint_row *question_row(const struct glint_pipeline *pipeline, size_t i,
                                            const struct glint_pass **pass) {
    for (size_t p = 0; p < glint_pipeline_pass_count(pipeline); p++) {
        *pass = glint_pipeline_pass(pipeline, p);
        for (size_t r = 0; r < (*pass)->row_count; r++) {
            const struct glint_row *row = &(*pass)->rows[r];
            if (row->kind == GLINT_ROW_ROLE && row->first == GLINT_ROLE_DEFINES_RESULT && i-- == 0) return row;
        }
    }
    return NULL;
}

/* The lobe that the pipeline's rays are drawn from, or the default if it draws none. */
static void find_lobe(const struct glint_pipeline *pipeline, char lobe[64]) {
    const char *name;
    const struct glint_pass *any = glint_pass_with_role(GLINT_ROLE_LOBE, &name);
    const struct glint_row *row = glint_pass_parameter(any, name);
    if (!parameter_text(pipeline, any->slot, name, lobe)) snprintf(lobe, 64, "%s", row->choices[(size_t)row->initial]);
}

/* The relative standard error of each pixel: 0 if the part declares none, +inf where no sample arrived. */
static bool truth_errors(struct glint_capture *capture, const struct glint_part_info *part, float **error,
                         struct glint_error *err) {
    const char *const channels[] = {glint_part_has_channel(part, "error") ? "error" : NULL, "weight"};
    const size_t pixels = (size_t)part->width * part->height;
    float *read = study_channels(capture, part->name, channels, 2, err);
    if (!read) return false;
    for (size_t i = 0; i < pixels; i++) read[i] = read[2 * i + 1] > 0 ? read[2 * i] : INFINITY;
    *error = read;
    return true;
}

bool glint_study_truth(struct glint_capture *capture, const struct glint_pipeline *pipeline,
                       struct glint_pixels *pixels, float **error, struct glint_error *err) {
    static const char *const rgb[] = {"R", "G", "B"};
    char name[96];
    *pixels = (struct glint_pixels){0};
    *error = NULL;
    char lobe[64];
    find_lobe(pipeline, lobe);
    snprintf(name, sizeof name, "truth.reflection.%s", lobe);
    const struct glint_part_info *part = glint_capture_find(capture, name);
    if (!part) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: missing", glint_capture_path(capture), name);
    *pixels = (struct glint_pixels){part->width, part->height, 3, study_channels(capture, name, rgb, 3, err)};
    return pixels->values && truth_errors(capture, part, error, err);
}

void study_question(const struct glint_pipeline *pipeline, char question[QUESTION_SIZE]) {
    const struct glint_pass *pass;
    char value[64];
    question[0] = 0;
    const struct glint_row *row;
    for (size_t i = 0; (row = question_row(pipeline, i, &pass)); i++) {
        const size_t end = strlen(question);
        if (parameter_text(pipeline, pass->slot, row->image, value))
            snprintf(question + end, QUESTION_SIZE - end, "%s%s.%s=%s", end ? " " : "", pass->slot, row->image, value);
    }
}

/* A value of run.json as parameter_text writes it. */
static void json_text(const json_t *value, char text[64]) {
    if (json_is_string(value)) snprintf(text, 64, "%s", json_string_value(value));
    else snprintf(text, 64, "%.17g", json_is_boolean(value) ? json_is_true(value) : json_number_value(value));
}

bool glint_study_fits(const struct glint_run *run, const char *folder, const struct glint_pipeline *pipeline,
                      struct glint_error *err) {
    const struct glint_pass *pass;
    const struct glint_row *row;
    json_t *json = json_loads(glint_run_json(run), 0, NULL), *theirs;
    bool ok = true;
    for (size_t i = 0, p; ok && (row = question_row(pipeline, i, &pass)); i++) {
        char value[64], other[64];
        if (!parameter_text(pipeline, pass->slot, row->image, value)) continue;
        json_array_foreach(json_object_get(json, "passes"), p, theirs) {
            const char *slot = json_string_value(json_object_get(theirs, "slot"));
            const json_t *found = json_object_get(json_object_get(theirs, "parameters"), row->image);
            if (!ok || !slot || strcmp(slot, pass->slot) != 0 || !found) continue;
            json_text(found, other);
            ok = !strcmp(value, other) ||
                 glint_fail(err, GLINT_ERROR_USAGE, "%s: expected a run with %s.%s=%s, as here, found %s", folder, slot,
                            row->image, value, other);
        }
    }
    json_decref(json);
    return ok;
}

struct glint_pipeline *glint_study_reference(const struct glint_pipeline *pipeline, struct glint_error *err) {
    struct glint_pipeline *reference = glint_pipeline_create("reference", err);
    const struct glint_pass *pass;
    const struct glint_row *row;
    for (size_t i = 0; reference && (row = question_row(pipeline, i, &pass)); i++) {
        char value[64], unused[64], assignment[256];
        if (!parameter_text(pipeline, pass->slot, row->image, value) ||
            !parameter_text(reference, pass->slot, row->image, unused))
            continue;
        snprintf(assignment, sizeof assignment, "%s.%s=%s", pass->slot, row->image, value);
        if (!glint_pipeline_set(reference, assignment, err)) glint_pipeline_destroy(&reference);
    }
    return reference;
}
