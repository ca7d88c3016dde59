/* Figures over many captures: means of each preset, paired differences of presets with their intervals, for all captures and for each tag; and which captures
   are the worst. */
#include <math.h>
#include <stdlib.h>

#include "compare/overall.h"

/* What is averaged: the figure of preset `to`, less that of preset `from` in the same capture unless both are the same. */
struct quantity {
    enum contest_figure figure;
    size_t from, to;
};

static bool find_mean(const struct contest_overall *o, const struct contest_log *log, size_t group, struct quantity q,
                      double *values, struct glint_figure *mean, struct glint_error *err) {
    for (size_t i = 0; i < log->captures->count; i++) {
        values[i] = contest_log_figure(log, i, q.to, q.figure);
        if (q.from != q.to) values[i] -= contest_log_figure(log, i, q.from, q.figure);
    }
    return capture_groups_mean(&o->captures, group, values, mean, err);
}

/* The preset with the least mean error; the first one where none is known. */
static size_t find_best(const struct contest_group *g, size_t presets) {
    size_t best = 0;
    for (size_t p = 1; p < presets; p++) {
        const double error = g->means[p * CONTEST_FIGURES + CONTEST_ERROR].value;
        const double least = g->means[best * CONTEST_FIGURES + CONTEST_ERROR].value;
        if (error < least || (isnan(least) && !isnan(error))) best = p;
    }
    return best;
}

static bool fill_group(struct contest_overall *o, const struct contest_log *log, size_t group, double *values,
                       struct glint_error *err) {
    const size_t presets = log->contest->count;
    struct contest_group *g = &o->groups[group];
    g->of = &o->captures.of[group];
    g->means = calloc(presets * CONTEST_FIGURES + 1, sizeof *g->means);
    g->pairs = calloc(presets * presets * CONTEST_PAIRED + 1, sizeof *g->pairs);
    bool ok = (g->means && g->pairs) || fail_memory(err);
    for (size_t p = 0; p < presets; p++)
        for (int f = 0; ok && f < CONTEST_FIGURES; f++)
            ok = find_mean(o, log, group, (struct quantity){(enum contest_figure)f, p, p}, values,
                           &g->means[p * CONTEST_FIGURES + (size_t)f], err);
    for (size_t a = 0; a < presets; a++)
        for (size_t b = a + 1; b < presets; b++)
            for (size_t f = 0; ok && f < CONTEST_PAIRED; f++) {
                struct glint_figure *pair = &g->pairs[(a * presets + b) * CONTEST_PAIRED + f];
                ok = find_mean(o, log, group, (struct quantity){(enum contest_figure)f, a, b}, values, pair, err);
                g->pairs[(b * presets + a) * CONTEST_PAIRED + f] =
                    (struct glint_figure){-pair->value, -pair->high, -pair->low};
            }
    if (ok) g->best = find_best(g, presets);
    return ok;
}

double contest_worst_error(const struct contest_log *log, size_t capture) {
    double worst = NAN;
    for (size_t p = 0; p < log->contest->count; p++)
        worst = fmax(worst, contest_log_figure(log, capture, p, CONTEST_ERROR)); /* which skips NAN */
    return worst;
}

static bool find_groups(struct contest_overall *o, const struct contest_log *log, struct glint_error *err) {
    const size_t count = log->captures->count;
    bool *done = calloc(count + 1, sizeof *done), ok = done || fail_memory(err);
    for (size_t i = 0; ok && i < count; i++) {
        done[i] = log->states[i] == CONTEST_DONE;
        o->unreadable += !done[i];
    }
    ok = ok && capture_groups_find(&o->captures, log->captures, done, err);
    free(done);
    return ok && ((o->groups = calloc(o->captures.count, sizeof *o->groups)) || fail_memory(err));
}

bool contest_overall_find(struct contest_overall *o, const struct contest_log *log, struct glint_error *err) {
    const size_t count = log->captures->count;
    *o = (struct contest_overall){.order = malloc((count + 1) * sizeof *o->order)};
    double *values = malloc((count + 1) * sizeof *values);
    bool ok = ((values && o->order) || fail_memory(err)) && find_groups(o, log, err);
    for (size_t i = 0; ok && i < count; i++) values[i] = contest_worst_error(log, i);
    ok = ok && capture_groups_rank(&o->captures, values, o->order, err);
    for (size_t g = 0; ok && g < o->captures.count; g++) ok = fill_group(o, log, g, values, err);
    free(values);
    return ok;
}

void contest_overall_finish(struct contest_overall *o) {
    for (size_t g = 0; o->groups && g < o->captures.count; g++) {
        free(o->groups[g].means);
        free(o->groups[g].pairs);
    }
    free(o->groups);
    free(o->order);
    capture_groups_finish(&o->captures);
    *o = (struct contest_overall){0};
}
