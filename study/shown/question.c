/* The parameters that define what a pipeline estimates, whether a run answers the same question, and the reference of a pipeline. */
#include "question.h"
#include "glint/study.h"

#include <stdio.h>
#include <string.h>

#include <jansson.h>

#include "no_memory.h"

bool study_parameter_text(const struct glint_pipeline *pipeline, const char *slot, const char *name, char text[64]) {
    const struct glint_pass *pass = glint_pipeline_find(pipeline, slot);
    const struct glint_row *row = pass ? glint_pass_parameter(pass, name) : NULL;
    if (!row) return false;
    const double value = glint_pipeline_value(pipeline, pass, row);
    if (row->choices) snprintf(text, 64, "%s", row->choices[(size_t)value]);
    else snprintf(text, 64, "%.17g", value);
    return true;
}

bool study_concerns(const struct glint_effect *effect, const struct glint_pass *pass) {
    const struct glint_effect *own = glint_effect_find(pass->effect);
    return !own || glint_effect_has(effect, pass);
}

/* The i-th row with role DEFINES_RESULT among the pipeline's passes, without those of effects other than `effect` (NULL: with all); NULL past
   the last. */
static const struct glint_row *question_row(const struct glint_pipeline *pipeline, const struct glint_effect *effect,
                                            size_t i, const struct glint_pass **pass) {
    for (size_t p = 0; p < glint_pipeline_pass_count(pipeline); p++) {
        *pass = glint_pipeline_pass(pipeline, p);
        if (effect && !study_concerns(effect, *pass)) continue;
        for (size_t r = 0; r < (*pass)->row_count; r++) {
            const struct glint_row *row = &(*pass)->rows[r];
            if (row->kind == GLINT_ROW_ROLE && row->first == GLINT_ROLE_DEFINES_RESULT && i-- == 0) return row;
        }
    }
    return NULL;
}

void study_question(const struct glint_pipeline *pipeline, const struct glint_effect *effect,
                    char question[QUESTION_SIZE]) {
    const struct glint_pass *pass;
    char value[64];
    question[0] = 0;
    const struct glint_row *row;
    for (size_t i = 0; (row = question_row(pipeline, effect, i, &pass)); i++) {
        const size_t end = strlen(question);
        if (study_parameter_text(pipeline, pass->slot, row->image, value))
            snprintf(question + end, QUESTION_SIZE - end, "%s%s.%s=%s", end ? " " : "", pass->slot, row->image, value);
    }
}

/* A value of run.json as study_parameter_text writes it. */
static void json_text(const json_t *value, char text[64]) {
    if (json_is_string(value)) snprintf(text, 64, "%s", json_string_value(value));
    else snprintf(text, 64, "%.17g", json_is_boolean(value) ? json_is_true(value) : json_number_value(value));
}

bool glint_study_fits(const struct glint_run *run, const char *folder, const struct glint_pipeline *pipeline,
                      const struct glint_effect *effect, struct glint_error *err) {
    const struct glint_pass *pass;
    const struct glint_row *row;
    json_t *json = json_loads(glint_run_json(run), 0, NULL), *theirs;
    bool ok = json || no_memory(err, folder);
    for (size_t i = 0, p; ok && (row = question_row(pipeline, effect, i, &pass)); i++) {
        char value[64], other[64];
        if (!study_parameter_text(pipeline, pass->slot, row->image, value)) continue;
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
    for (size_t i = 0; reference && (row = question_row(pipeline, NULL, i, &pass)); i++) {
        char value[64], unused[64], assignment[256];
        if (!study_parameter_text(pipeline, pass->slot, row->image, value) ||
            !study_parameter_text(reference, pass->slot, row->image, unused))
            continue;
        snprintf(assignment, sizeof assignment, "%s.%s=%s", pass->slot, row->image, value);
        if (!glint_pipeline_set(reference, assignment, err)) glint_pipeline_destroy(&reference);
    }
    return reference;
}
