/* Compares a pixel with what is right and tries single changes of its pipeline. Nothing is said to help that was not tried. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "explain/explain.h"

static const double SMALL = 0.02; /* symmetric error below which a pixel counts as right */
static const double SOLVED = 0.1; /* part of the error that may be left when a change counts as the cause */
static const double WORTH = 0.7;  /* part that may be left when it is worth naming */

double explain_error(const double *found, const double *right) {
    double sum = 0;
    for (int c = 0; c < 3; c++)
        sum += fabs(found[c] - right[c]) / (fabs(found[c]) + fabs(right[c]) + GLINT_SYMMETRIC_EPSILON);
    return sum / 3;
}

/* ---- Errors of a run ---- */

void explain_triple(const struct glint_pixels *pixels, size_t at, double triple[3]) {
    const float *values = pixels->values + at * pixels->components;
    for (uint32_t c = 0; c < 3; c++) triple[c] = (double)values[pixels->components < 3 ? 0 : c];
}

static bool true_at(const struct explain *e, uint32_t x, uint32_t y, double right[3]) {
    const size_t at = (size_t)y * e->true_pixels.width + x;
    if (!e->truth || (e->true_error && !isfinite(e->true_error[at]))) return false;
    explain_triple(&e->true_pixels, at, right);
    return true;
}

/* Of the pixel, and the mean over those around it. */
static bool result_error(const struct explain *e, struct explain_try *t, struct glint_error *err) {
    struct glint_pixels found;
    if (!glint_study_result(e->opened->replay, e->effect, &found, err)) return false;
    const uint32_t x = e->probe.pixel[0], y = e->probe.pixel[1];
    double sum = 0;
    size_t count = 0;
    t->error = NAN;
    for (uint32_t v = y < EXPLAIN_AROUND ? 0 : y - EXPLAIN_AROUND; v <= y + EXPLAIN_AROUND && v < found.height; v++)
        for (uint32_t u = x < EXPLAIN_AROUND ? 0 : x - EXPLAIN_AROUND; u <= x + EXPLAIN_AROUND && u < found.width;
             u++) {
            double right[3], own[3];
            if (!true_at(e, u, v, right)) continue;
            explain_triple(&found, (size_t)v * found.width + u, own);
            const double error = explain_error(own, right);
            if (u == x && v == y) t->error = error;
            sum += error;
            count++;
        }
    t->around = count ? sum / (double)count : NAN;
    glint_pixels_finish(&found);
    return true;
}

/* Of the texel's ray against the same ray of the reference tracers. */
static bool ray_error(const struct explain *e, struct explain_try *t, struct glint_error *err) {
    const struct probe_value *right = explain_radiance(&e->probe.reference, GLINT_ROLE_RAY_RADIANCE);
    const struct glint_image *image = glint_replay_find_image(e->opened->replay, right->row->name);
    t->error = t->around = NAN;
    if (!image || e->probe.texel[0] >= image->width || e->probe.texel[1] >= image->height) return true;
    float *values = malloc((size_t)image->width * image->height * image->components * sizeof *values);
    bool ok = values || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    ok = ok && glint_replay_read_image(e->opened->replay, image, GLINT_F32, values, err);
    if (ok) {
        const float *v = values + ((size_t)e->probe.texel[1] * image->width + e->probe.texel[0]) * image->components;
        t->error = explain_error((double[]){(double)v[0], (double)v[1], (double)v[2]}, right->values);
    }
    free(values);
    return ok;
}

static bool measure(const struct explain *e, const struct glint_pipeline *pipeline, struct explain_try *t,
                    struct glint_error *err) {
    struct glint_replay_options options = e->options;
    options.keep_bytes = (uint64_t)1 << 30;
    return glint_replay_run(e->opened->replay, pipeline, &options, NULL, NULL, err) &&
           (e->goal == EXPLAIN_RAY ? ray_error(e, t, err) : result_error(e, t, err));
}

/* ---- What can be tried ---- */

static bool is_better(const struct explain_try *a, const struct explain_try *b) {
    return a->error < b->error && !(a->around > b->around); /* around: no luck of a single pixel */
}

static bool solved(const struct explain *e, const struct explain_try *t) {
    return t->error <= SOLVED * e->start.error;
}

static bool try_change(struct explain *e, const struct explain_try *change, struct glint_error *err) {
    if (e->tried >= e->limit) return e->more = true;
    if (e->best.change[0] && solved(e, &e->best)) return true;
    char text[96];
    snprintf(text, sizeof text, "trying %zu of at most %zu changes", e->tried + 1, e->limit);
    if (!progress_report(e->progress, text, (double)e->tried / (double)e->limit))
        return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted after %zu changes", e->tried);
    struct explain_try *t = &e->tries[e->tried];
    *t = *change;
    struct glint_pipeline *copy = glint_pipeline_copy(e->opened->pipeline, err);
    bool ok = copy != NULL;
    /* What does not fit, such as a variant whose inputs nobody makes, is no change to try. */
    const bool fits = ok && (t->variant ? glint_pipeline_use : glint_pipeline_set)(copy, t->change, NULL);
    if (fits && (ok = measure(e, copy, t, err))) {
        e->tried++;
        if (is_better(t, e->best.change[0] ? &e->best : &e->start)) e->best = *t;
    }
    if (copy) glint_pipeline_destroy(&copy);
    return ok;
}

static bool try_value(struct explain *e, const struct glint_pass *pass, const struct glint_row *row, double value,
                      struct glint_error *err) {
    struct explain_try change = {.error = NAN};
    const double now = glint_pipeline_value(e->opened->pipeline, pass, row);
    if (row->type != GLINT_VALUE_FLOAT) value = round(value);
    value = fmin(fmax(value, row->lowest), row->highest);
    if (value == now || !isfinite(value)) return true;
    if (row->choices) {
        snprintf(change.change, sizeof change.change, "%s.%s=%s", pass->slot, row->name, row->choices[(size_t)value]);
        snprintf(change.before, sizeof change.before, "%s", row->choices[(size_t)now]);
    } else if (row->type == GLINT_VALUE_BOOL) {
        snprintf(change.change, sizeof change.change, "%s.%s=%s", pass->slot, row->name, value != 0 ? "true" : "false");
        snprintf(change.before, sizeof change.before, "%s", now != 0 ? "true" : "false");
    } else {
        snprintf(change.change, sizeof change.change, "%s.%s=%.6g", pass->slot, row->name, value);
        snprintf(change.before, sizeof change.before, "%.6g", now);
    }
    return try_change(e, &change, err);
}

/* Defines what is estimated, so that another value would be right about something else. */
static bool defines_result(const struct glint_pass *pass, const char *name) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_ROLE && pass->rows[r].first == GLINT_ROLE_DEFINES_RESULT &&
            !strcmp(pass->rows[r].image, name))
            return true;
    return false;
}

static bool try_parameter(struct explain *e, const struct glint_pass *pass, const struct glint_row *row,
                          struct glint_error *err) {
    const double now = glint_pipeline_value(e->opened->pipeline, pass, row);
    if (defines_result(pass, row->name)) return true;
    if (row->choices) {
        for (size_t i = 0; row->choices[i]; i++)
            if (!try_value(e, pass, row, (double)i, err)) return false;
        return true;
    }
    if (row->type == GLINT_VALUE_BOOL) return try_value(e, pass, row, now == 0, err);
    if (now == 0) return try_value(e, pass, row, row->initial != 0 ? row->initial : row->highest, err);
    return try_value(e, pass, row, 4 * now, err) && try_value(e, pass, row, now / 4, err);
}

/* Whether the row limits the steps of a ray that used all of them: such are tried before others. */
static bool limits(const struct explain *e, const struct glint_pass *pass, const struct glint_row *row) {
    const struct glint_probe_record *end = explain_record(&e->probe.own, pass, "screen_end", true);
    if (!end) end = explain_record(&e->probe.own, pass, "cubemap_end", true);
    const char *why = end ? glint_probe_label("end reason", glint_probe_value(end, "end")).name : NULL;
    return why && !strcmp(why, "steps_exhausted") && (!strcmp(row->unit, "steps") || !strcmp(row->unit, "cells"));
}

static bool try_pass(struct explain *e, const struct glint_pass *pass, struct glint_error *err) {
    for (int first = 1; first >= 0; first--)
        for (size_t r = 0; r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            if (glint_row_is_parameter(row) && limits(e, pass, row) == first && !try_parameter(e, pass, row, err))
                return false;
        }
    return true;
}

static bool try_rays(struct explain *e, struct glint_error *err) {
    const uint32_t rays = glint_pipeline_rays(e->opened->pipeline);
    struct explain_try change = {.error = NAN};
    snprintf(change.change, sizeof change.change, "pipeline.rays=%u", rays * 16 < 1024 ? rays * 16 : 1024);
    snprintf(change.before, sizeof change.before, "%u", rays);
    return rays >= 1024 || try_change(e, &change, err);
}

static bool try_variants(struct explain *e, const struct glint_pass *pass, struct glint_error *err) {
    size_t count;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i++) {
        struct explain_try change = {.variant = true, .error = NAN};
        if (strcmp(passes[i].slot, pass->slot) || !strcmp(passes[i].variant, pass->variant)) continue;
        snprintf(change.change, sizeof change.change, "%s=%s", pass->slot, passes[i].variant);
        snprintf(change.before, sizeof change.before, "%s", pass->variant);
        if (!try_change(e, &change, err)) return false;
    }
    return true;
}

/* Where the pass stands to the one that samples the colour of rays: before it and no source of other rays, or behind it. */
enum place { PLACE_RAY, PLACE_TRACE, PLACE_FILTER, PLACE_COMPOSE };
static enum place place_of(const struct glint_pipeline *pipeline, const struct glint_pass *pass) {
    bool colored = false;
    if (glint_pass_role(pass, GLINT_ROLE_RAY_PICK)) return PLACE_RAY;
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *other = glint_pipeline_pass(pipeline, i);
        if (other == pass) break;
        if (glint_pass_role(other, GLINT_ROLE_COMPOSED)) return PLACE_COMPOSE;
        colored |= glint_pass_role(other, GLINT_ROLE_RAY_RADIANCE) != NULL;
    }
    if (glint_pass_role(pass, GLINT_ROLE_COMPOSED)) return PLACE_COMPOSE;
    return colored ? PLACE_FILTER : PLACE_TRACE;
}

/* The passes of one place whose images this pixel depends on, those of `first` before the others. */
static bool try_place(struct explain *e, enum place place, const struct glint_pass *first, bool variants,
                      struct glint_error *err) {
    const struct probe_side *own = &e->probe.own;
    bool (*const each)(struct explain *, const struct glint_pass *, struct glint_error *) =
        variants ? try_variants : try_pass;
    if (first && !each(e, first, err)) return false;
    for (size_t p = own->pass_count; p-- > 0;) {
        const struct glint_pass *pass = own->passes[p].pass;
        if (pass != first && own->passes[p].shown && place_of(e->opened->pipeline, pass) == place &&
            !each(e, pass, err))
            return false;
    }
    return true;
}

/* The tracer whose end differs, first of all: nothing else can be wrong before it. */
static const struct glint_pass *suspect(const struct explain *e) {
    const struct glint_probe_record *end, *right;
    const struct glint_pass *own = NULL;
    for (size_t i = 0; (own = explain_tracer(&e->probe.own, i, &end)); i++) {
        const struct glint_pass *other = explain_tracer(&e->probe.reference, i, &right);
        const bool last = !explain_tracer(&e->probe.own, i + 1, &(const struct glint_probe_record *){NULL});
        if (last || !other || glint_probe_value(end, "end") != glint_probe_value(right, "end")) return own;
    }
    return NULL;
}

static bool try_all(struct explain *e, struct glint_error *err) {
    if (e->goal == EXPLAIN_RAY) {
        const struct glint_pass *first = suspect(e);
        return try_place(e, PLACE_TRACE, first, false, err) && try_place(e, PLACE_TRACE, first, true, err);
    }
    if (!try_rays(e, err)) return false;
    /* Mostly noise, which other parameters may lower by chance. */
    if (e->best.change[0] && e->best.error <= WORTH * e->start.error) return true;
    return try_place(e, PLACE_FILTER, NULL, false, err) && try_place(e, PLACE_RAY, NULL, false, err) &&
           try_place(e, PLACE_TRACE, NULL, false, err) && try_place(e, PLACE_FILTER, NULL, true, err);
}

/* ---- Goal ---- */

/* Whether the ray brings another colour than it should, wherever it ends. */
static bool ray_is_wrong(const struct explain *e) {
    const struct probe_value *own = explain_radiance(&e->probe.own, GLINT_ROLE_RAY_RADIANCE);
    const struct probe_value *right = explain_radiance(&e->probe.reference, GLINT_ROLE_RAY_RADIANCE);
    return e->probe.has_reference && own && right && explain_error(own->values, right->values) > SMALL;
}

/* An error within twice the noise of what it is compared with says nothing. */
static bool is_noise(const struct explain *e) {
    const size_t at = (size_t)e->probe.pixel[1] * e->true_pixels.width + e->probe.pixel[0];
    return e->true_error && !(e->start.error > (double)e->true_error[at]);
}

static bool measure_start(struct explain *e, enum explain_goal goal, struct glint_error *err) {
    e->goal = goal;
    e->start = (struct explain_try){.error = NAN};
    if (!measure(e, e->opened->pipeline, &e->start, err)) return false;
    e->within_noise = e->start.error > SMALL && goal == EXPLAIN_RESULT && is_noise(e);
    if (!(e->start.error > SMALL) || e->within_noise) e->goal = EXPLAIN_NOTHING;
    return true;
}

bool explain_find(struct explain *e, struct glint_error *err) {
    const struct glint_probe_record *end;
    e->goal = EXPLAIN_NOTHING;
    if (!explain_last_tracer(&e->probe.own, &end)) return true;
    if (ray_is_wrong(e) ? !measure_start(e, EXPLAIN_RAY, err) : e->truth && !measure_start(e, EXPLAIN_RESULT, err))
        return false;
    if (e->goal == EXPLAIN_NOTHING || !e->limit) return true;
    if (!(e->tries = calloc(e->limit, sizeof *e->tries))) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (!try_all(e, err)) return false;
    if (e->best.change[0] && !(e->best.error <= WORTH * e->start.error)) e->best.change[0] = '\0';
    return true;
}
