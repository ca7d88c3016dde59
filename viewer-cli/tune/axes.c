/* Chooses the parameters to tune: those of --vary, or all declared ones that can influence the result. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/pass_names.h"
#include "tune/tune.h"

void tune_value_text(const struct tune_axis *axis, double value, char text[TUNE_TEXT]) {
    if (axis->texts) snprintf(text, TUNE_TEXT, "%s", axis->texts[(size_t)value]);
    else snprintf(text, TUNE_TEXT, "%.9g", value);
}

bool tune_slot_counts(const struct tune *tune, const char *slot) {
    bool counts = !tune->slots.count;
    for (size_t k = 0; k < tune->slots.count; k++) counts |= !strcmp(slot, tune->slots.items[k]);
    return counts;
}

static bool is_rays(const char *name) {
    return !strcmp(name, "pipeline.rays");
}
static bool is_variant(const char *name) {
    return !strchr(name, '.');
}

/* Applies variants first, because parameters of other variants are left out. */
struct glint_pipeline *tune_pipeline(const struct tune *tune, const double *values, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_copy(tune->base, err);
    bool ok = pipeline != NULL;
    for (int variants = 1; variants >= 0; variants--)
        for (size_t a = 0; ok && a < tune->axis_count; a++) {
            const struct tune_axis *axis = &tune->axes[a];
            const struct glint_pass *pass;
            char text[TUNE_TEXT], assignment[200];
            if (is_variant(axis->name) != (variants == 1)) continue;
            if (axis->row && !glint_pipeline_parameter(pipeline, axis->name, &pass, NULL)) continue;
            tune_value_text(axis, values[a], text);
            snprintf(assignment, sizeof assignment, "%s=%s", axis->name, text);
            ok = variants ? glint_pipeline_use(pipeline, assignment, err)
                          : glint_pipeline_set(pipeline, assignment, err);
        }
    if (!ok && pipeline) glint_pipeline_destroy(&pipeline);
    return pipeline;
}

/* Whether the parameter is a count whose elements each cost time; taps of filters do not count as fetches of the trace passes. */
static bool is_count(const struct tune *tune, const struct tune_axis *axis) {
    static const char *const units[] = {"steps", "cells", "samples", "taps"};
    char slot[128];
    if (axis->texts || axis->other) return false;
    if (is_rays(axis->name)) return true;
    snprintf(slot, sizeof slot, "%.*s", (int)strcspn(axis->name, "."), axis->name);
    if (!axis->row || !axis->axis.whole || !tune_slot_counts(tune, slot)) return false;
    for (size_t i = 0; i < sizeof units / sizeof *units - tune->fetches; i++)
        if (!strcmp(axis->row->unit, units[i])) return true;
    return false;
}

bool tune_scale(const struct tune *tune, double factor, double *values) {
    bool some = false;
    for (size_t a = 0; a < tune->axis_count; a++) {
        const struct glint_search_axis *axis = &tune->axes[a].axis;
        const bool count = is_count(tune, &tune->axes[a]);
        values[a] = count ? fmin(fmax(round(axis->start * factor), axis->lowest), axis->highest) : axis->start;
        some |= count;
    }
    return some;
}

/* ---- Why a parameter is not tuned ---- */

static bool same_values(const struct glint_pipeline *a, const struct glint_pipeline *b) {
    for (size_t i = 0; i < glint_pipeline_pass_count(a); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(a, i);
        for (size_t r = 0; r < pass->row_count; r++)
            if (glint_row_is_parameter(&pass->rows[r]) &&
                glint_pipeline_value(a, pass, &pass->rows[r]) != glint_pipeline_value(b, pass, &pass->rows[r]))
                return false;
    }
    return true;
}

/* Whether another value of this parameter would change the reference. */
static bool asks_otherwise(const struct tune *tune, const char *name, const struct glint_row *row, double start,
                           bool *otherwise, struct glint_error *err) {
    char assignment[200];
    const double value = start == row->lowest ? row->highest : row->lowest;
    struct glint_pipeline *copy = glint_pipeline_copy(tune->base, err), *a = NULL, *b = NULL;
    if (row->choices) snprintf(assignment, sizeof assignment, "%s=%s", name, row->choices[(size_t)value]);
    else snprintf(assignment, sizeof assignment, "%s=%.9g", name, value);
    const bool ok = copy && glint_pipeline_set(copy, assignment, err) && (a = glint_study_reference(tune->base, err)) &&
                    (b = glint_study_reference(copy, err));
    *otherwise = ok && !same_values(a, b);
    if (a) glint_pipeline_destroy(&a);
    if (b) glint_pipeline_destroy(&b);
    if (copy) glint_pipeline_destroy(&copy);
    return ok;
}

static bool is_assumed(const struct glint_pass *pass, const char *name) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_ASSUMED && !strcmp(pass->rows[r].name, name)) return true;
    return false;
}

/* State of a pass over all captures. */
struct part {
    bool ran, cached, needed;
    char reason[192];
};

json_t *tune_slots(struct tune *tune, struct tune_subject *subject, struct glint_error *err) {
    struct glint_replay *replay = glint_judge_replay(subject->judge);
    const struct glint_image *image = glint_study_result_image(replay, tune->against.effect);
    const char *const outputs[] = {image ? image->name : NULL, NULL};
    const struct glint_replay_options options = {.outputs = outputs, .all = tune->all};
    const struct glint_plan_entry *entries;
    size_t count = 0, planned = 0;
    json_t *slots = json_object();
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t i = 0; slots && i < count; i++)
        json_object_set_new(slots, results[i].pass->slot,
                            json_pack("{s:b, s:b, s:b, s:s}", "ran", results[i].ran, "cached", results[i].cached_work,
                                      "needed", false, "reason", results[i].ran ? "" : results[i].reason));
    if (slots && image && !glint_replay_plan(replay, tune->base, &options, &entries, &planned, err)) {
        json_decref(slots);
        return NULL;
    }
    for (size_t i = 0; slots && i < planned; i++) {
        json_t *slot = json_object_get(slots, entries[i].pass->slot);
        if (slot && entries[i].runs) json_object_set_new(slot, "needed", json_true());
    }
    if (!slots) fail_memory(err);
    return slots;
}

/* Adds what a pass of the start did on one capture. */
static void add_part(const struct tune_subject *subject, const char *slot, struct part *part) {
    const json_t *found = json_object_get(subject->slots, slot);
    const char *reason = json_string_value(json_object_get(found, "reason"));
    part->ran |= json_is_true(json_object_get(found, "ran"));
    part->cached |= json_is_true(json_object_get(found, "cached"));
    part->needed |= json_is_true(json_object_get(found, "needed"));
    if (reason) snprintf(part->reason, sizeof part->reason, "%.191s", reason);
}

static void leave(struct tune *tune, const char *name, const char *why, const char *more) {
    struct tune_left *left = &tune->left[tune->left_count++];
    snprintf(left->name, sizeof left->name, "%s", name);
    snprintf(left->why, sizeof left->why, "%s%s", why, more);
}

static const char not_needed[] = "does not influence the ";

static const char *why_left(const struct tune *tune, const struct glint_pass *pass, const struct glint_row *row,
                            const struct part *part, bool otherwise) {
    if (!part->ran) return "does not run: ";
    if (pass->host) return "is used on the host only: it costs memory, but no frame time";
    if (part->cached) return "is used for cube maps, which are not processed every frame";
    if (!part->needed) return not_needed;
    if (otherwise) return "would change the reference";
    if (!tune->against.truth && is_assumed(pass, row->name))
        return "is an assumption about the scene, which the reference makes too";
    return NULL;
}

/* ---- Axes ---- */

static void number_axis(struct tune_axis *axis, double lowest, double highest, double start, bool whole) {
    axis->axis = (struct glint_search_axis){.lowest = lowest,
                                            .highest = highest,
                                            .start = start,
                                            .whole = whole,
                                            .scale = glint_search_scale(lowest, highest, start)};
}

static bool add_text(struct tune_axis *axis, const char *text, size_t length, struct glint_error *err) {
    void *larger = realloc(axis->texts, (axis->axis.choices + 1) * sizeof *axis->texts);
    if (!larger) return fail_memory(err);
    axis->texts = larger;
    snprintf(axis->texts[axis->axis.choices++], TUNE_TEXT, "%.*s", (int)length, text);
    return true;
}

/* The whole declared range. */
static bool declared_axis(struct tune_axis *axis, const struct glint_row *row, double start, struct glint_error *err) {
    axis->row = row;
    if (row->choices || row->type == GLINT_VALUE_BOOL) {
        static const char *const switches[] = {"false", "true", NULL};
        for (const char *const *name = row->choices ? row->choices : switches; *name; name++)
            if (!add_text(axis, *name, strlen(*name), err)) return false;
        axis->axis.start = start;
        return true;
    }
    number_axis(axis, row->lowest, row->highest, start, row->type != GLINT_VALUE_FLOAT);
    return true;
}

static bool add_all(struct tune *tune, struct glint_error *err) {
    for (size_t i = 0; i < glint_pipeline_pass_count(tune->base); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(tune->base, i);
        struct part part = {0};
        for (size_t s = 0; s < tune->captures.count; s++) add_part(&tune->subjects[s], pass->slot, &part);
        for (size_t r = 0; r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            if (!glint_row_is_parameter(row)) continue;
            struct tune_axis *axis = &tune->axes[tune->axis_count];
            const double start = glint_pipeline_value(tune->base, pass, row);
            bool otherwise = false;
            snprintf(axis->name, sizeof axis->name, "%s.%s", pass->slot, row->name);
            if (!declared_axis(axis, row, start, err) || !asks_otherwise(tune, axis->name, row, start, &otherwise, err))
                return false;
            const char *why = why_left(tune, pass, row, &part, otherwise);
            if (!why) {
                tune->axis_count++;
                continue;
            }
            leave(tune, axis->name, why, !part.ran ? part.reason : why == not_needed ? tune->against.effect->noun : "");
            free(axis->texts);
            *axis = (struct tune_axis){0};
        }
    }
    return true;
}

static bool fail_vary(const struct tune_axis *axis, const char *expected, const char *found, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s: expected %s, found '%s'", axis->name, expected, found);
}

/* "a,b,c": each must be a valid value; the start value is added in front if it is missing. */
static bool read_list(const struct tune *tune, struct tune_axis *axis, const char *list, const char *start,
                      struct glint_error *err) {
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        const size_t length = strcspn(at, ",");
        char assignment[200];
        snprintf(assignment, sizeof assignment, "%s=%.*s", axis->name, (int)length, at);
        if (!length || length >= TUNE_TEXT) return fail_vary(axis, "values separated by commas", list, err);
        struct glint_pipeline *copy = glint_pipeline_copy(tune->base, err);
        struct glint_error own = {0};
        const bool ok = copy && (is_variant(axis->name) ? glint_pipeline_use(copy, assignment, &own)
                                                        : glint_pipeline_set(copy, assignment, &own));
        if (copy) glint_pipeline_destroy(&copy);
        if (!ok) return glint_fail(err, own.code, "--vary %s: %s", axis->name, own.message);
        if (!add_text(axis, at, length, err)) return false;
    }
    for (uint32_t c = 0; c < axis->axis.choices; c++)
        if (!strcmp(axis->texts[c], start)) {
            axis->axis.start = c;
            return true;
        }
    axis->axis.start = axis->axis.choices;
    return add_text(axis, start, strlen(start), err);
}

static bool read_range(struct tune_axis *axis, const char *range, double lowest, double highest, double start,
                       bool whole, struct glint_error *err) {
    char *end, low_text[TUNE_TEXT], shown[160];
    const char *dots = strstr(range, "..");
    snprintf(low_text, sizeof low_text, "%.*s", (int)(dots - range), range); /* "4." would be a number */
    const double low = strtod(low_text, &end);
    bool ok = end != low_text && !*end;
    const double high = strtod(dots + 2, &end);
    ok = ok && end != dots + 2 && !*end && isfinite(low) && isfinite(high) && low < high;
    if (!ok) return fail_vary(axis, "A..B with A below B", range, err);
    snprintf(shown, sizeof shown, "a range within %.9g to %.9g", lowest, highest);
    if (low < lowest || high > highest) return fail_vary(axis, shown, range, err);
    if (whole && (low != floor(low) || high != floor(high))) return fail_vary(axis, "whole numbers", range, err);
    snprintf(shown, sizeof shown, "a range that contains the start value %.9g", start);
    if (start < low || start > high) return fail_vary(axis, shown, range, err);
    number_axis(axis, low, high, start, whole);
    return true;
}

/* The parameter in a variant that an axis can choose. */
static const struct glint_row *find_other_row(const struct tune *tune, const char *name) {
    const struct glint_row *row = NULL;
    for (size_t a = 0; a < tune->axis_count; a++) {
        const struct tune_axis *axis = &tune->axes[a];
        const size_t length = strlen(axis->name);
        if (!is_variant(axis->name) || strncmp(axis->name, name, length) != 0 || name[length] != '.') continue;
        for (uint32_t c = 0; c < axis->axis.choices && !row; c++) {
            const struct glint_pass *pass = glint_pass_find(axis->name, axis->texts[c]);
            row = pass ? glint_pass_parameter(pass, name + length + 1) : NULL;
        }
    }
    return row;
}

/* SLOT.PARAMETER[=A..B|A,B], pipeline.rays=A..B, SLOT=VARIANT,VARIANT */
static bool read_vary(const struct tune *tune, const char *text, struct tune_axis *axis, struct glint_error *err) {
    const char *equals = strchr(text, '='), *values = equals ? equals + 1 : NULL;
    char start[TUNE_TEXT];
    const int length = (int)(equals ? equals - text : (long)strlen(text));
    snprintf(axis->name, sizeof axis->name, "%.*s", length, text);
    if (!length || length >= (int)sizeof axis->name || (values && !*values))
        return glint_fail(
            err, GLINT_ERROR_USAGE,
            "--vary: expected SLOT.PARAMETER, SLOT.PARAMETER=A..B, a list A,B or SLOT=VARIANT,VARIANT, found '%s'",
            text);
    if (is_variant(axis->name)) {
        const struct glint_pass *pass = glint_pipeline_find(tune->base, axis->name);
        if (!glint_slot_check(axis->name, err)) return false;
        if (!values) return fail_vary(axis, "variants, such as SLOT=A,B", text, err);
        return read_list(tune, axis, values, pass ? pass->variant : GLINT_NO_VARIANT, err);
    }
    if (is_rays(axis->name)) {
        const double rays = glint_pipeline_rays(tune->base);
        snprintf(start, sizeof start, "%.0f", rays);
        if (!values || !strstr(values, "..")) return fail_vary(axis, "A..B", values ? values : "nothing", err);
        return read_range(axis, values, 1, 1024, rays, true, err);
    }
    struct glint_error own_error = {0};
    const struct glint_pass *pass;
    const struct glint_row *row = glint_pipeline_parameter(tune->base, axis->name, &pass, &own_error);
    const bool own = row != NULL;
    if (!own) row = find_other_row(tune, axis->name);
    axis->other = !own;
    if (!row) return glint_fail(err, own_error.code, "--vary %s: %s", axis->name, own_error.message);
    const double value = own ? glint_pipeline_value(tune->base, pass, row) : row->initial;
    bool otherwise = false;
    if (own && !asks_otherwise(tune, axis->name, row, value, &otherwise, err)) return false;
    if (otherwise)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "--vary %s: would change the reference, so errors could not be compared", axis->name);
    if (!values) return declared_axis(axis, row, value, err);
    axis->row = row;
    if (!strstr(values, "..")) {
        snprintf(start, sizeof start, "%s", value_text(row, value));
        return read_list(tune, axis, values, start, err);
    }
    if (row->choices || row->type == GLINT_VALUE_BOOL) return fail_vary(axis, "a list of choices", values, err);
    return read_range(axis, values, row->lowest, row->highest, value, row->type != GLINT_VALUE_FLOAT, err);
}

bool tune_make_axes(struct tune *tune, struct glint_error *err) {
    size_t room = tune->vary.count + 1;
    for (size_t i = 0; i < glint_pipeline_pass_count(tune->base); i++)
        room += glint_pipeline_pass(tune->base, i)->row_count;
    tune->axes = calloc(room, sizeof *tune->axes);
    tune->left = calloc(room, sizeof *tune->left);
    if (!tune->axes || !tune->left) return fail_memory(err);
    if (!tune->vary.count) return add_all(tune, err);
    for (size_t i = 0; i < 2 * tune->vary.count; i++) { /* variants first */
        const char *text = tune->vary.items[i % tune->vary.count];
        const size_t dot = strcspn(text, ".");
        if ((dot < strcspn(text, "=")) != (i >= tune->vary.count)) continue;
        struct tune_axis *axis = &tune->axes[tune->axis_count++];
        if (!read_vary(tune, text, axis, err)) return false;
        for (size_t k = 0; k + 1 < tune->axis_count; k++)
            if (!strcmp(tune->axes[k].name, axis->name))
                return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s is given twice", axis->name);
    }
    return true;
}
