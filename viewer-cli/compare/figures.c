/* Figures over many captures: means of each preset, paired differences of presets with their intervals, for all captures and for each tag; and which captures
   are the worst. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/overall.h"
#include "options/capture_set.h"

enum { RESAMPLES = 1000 };

/* ---- Shots ---- */

/* The length of FOLDER/NAME of a frame FOLDER/NAME.NNNN.exr of a shot; of other names that of the whole path. */
static size_t shot_length(const char *path) {
    const size_t all = strlen(path);
    size_t end = all > 4 ? all - 4 : 0, digits = end;
    if (!end || strcmp(path + end, ".exr") != 0) return all;
    while (digits > 0 && path[digits - 1] >= '0' && path[digits - 1] <= '9') digits--;
    return digits < end && digits > 1 && path[digits - 1] == '.' && path[digits - 2] != '/' ? digits - 1 : all;
}

/* Numbers the shots: those of captures whose paths begin alike. */
static bool number_shots(struct contest_overall *o, const struct list *captures, struct glint_error *err) {
    json_t *known = json_object();
    o->shots = malloc((captures->count + 1) * sizeof *o->shots);
    bool ok = (known && o->shots) || fail_memory(err);
    for (size_t i = 0; ok && i < captures->count; i++) {
        const size_t length = shot_length(captures->items[i]);
        char *name = strndup(captures->items[i], length);
        const json_t *number = name ? json_object_get(known, name) : NULL;
        if (name && !number) json_object_set_new_nocheck(known, name, json_integer((json_int_t)o->shot_count++));
        ok = (name && (number = json_object_get(known, name)) != NULL) || fail_memory(err);
        if (ok) o->shots[i] = (size_t)json_integer_value(number);
        free(name);
    }
    json_decref(known);
    return ok;
}

/* ---- Groups ---- */

static bool has_tag(const struct list *captures, size_t capture, const char *tag) {
    const json_t *tags = capture_set_tags(captures, capture);
    for (size_t i = 0; i < json_array_size(tags); i++)
        if (!strcmp(json_string_value(json_array_get(tags, i)), tag)) return true;
    return false;
}

/* Whether the capture counts for the group. */
static bool is_in(const struct contest_log *log, const struct contest_group *g, size_t capture) {
    return log->states[capture] == CONTEST_DONE && (!g->tag || has_tag(log->captures, capture, g->tag));
}

/* The group of all captures, and one for each tag, in the order in which the set has them. */
static bool find_groups(struct contest_overall *o, const struct list *captures, struct glint_error *err) {
    o->groups = calloc(CONTEST_GROUPS, sizeof *o->groups);
    if (!o->groups) return fail_memory(err);
    o->count = 1;
    for (size_t i = 0; i < captures->count; i++) {
        const json_t *tags = capture_set_tags(captures, i);
        for (size_t k = 0; k < json_array_size(tags) && o->count < CONTEST_GROUPS; k++) {
            const char *tag = json_string_value(json_array_get(tags, k));
            size_t g = 1;
            while (g < o->count && strcmp(o->groups[g].tag, tag) != 0) g++;
            if (g == o->count) o->groups[o->count++].tag = tag;
        }
    }
    return true;
}

static bool count_members(struct contest_group *g, const struct contest_overall *o, const struct contest_log *log,
                          struct glint_error *err) {
    bool *seen = calloc(o->shot_count + 1, sizeof *seen);
    if (!seen) return fail_memory(err);
    for (size_t i = 0; i < log->captures->count; i++) {
        if (!is_in(log, g, i)) continue;
        g->captures++;
        g->shots += !seen[o->shots[i]];
        seen[o->shots[i]] = true;
    }
    free(seen);
    return true;
}

/* What is averaged: the figure of preset `to`, less that of preset `from` in the same capture unless both are the same. */
struct quantity {
    enum contest_figure figure;
    size_t from, to;
};

static bool find_mean(const struct contest_overall *o, const struct contest_log *log, const struct contest_group *g,
                      struct quantity q, double *values, struct glint_figure *mean, struct glint_error *err) {
    const struct glint_clustered clustered = {.values = values,
                                              .clusters = o->shots,
                                              .count = log->captures->count,
                                              .cluster_count = o->shot_count,
                                              .resamples = RESAMPLES,
                                              .seed = 1};
    for (size_t i = 0; i < log->captures->count; i++) {
        values[i] = is_in(log, g, i) ? contest_log_figure(log, i, q.to, q.figure) : (double)NAN;
        if (q.from != q.to) values[i] -= contest_log_figure(log, i, q.from, q.figure);
    }
    return glint_clustered_mean(&clustered, mean, err);
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

static bool fill_group(struct contest_group *g, const struct contest_overall *o, const struct contest_log *log,
                       double *values, struct glint_error *err) {
    const size_t presets = log->contest->count;
    g->means = calloc(presets * CONTEST_FIGURES + 1, sizeof *g->means);
    g->pairs = calloc(presets * presets * CONTEST_PAIRED + 1, sizeof *g->pairs);
    bool ok = (g->means && g->pairs) || fail_memory(err);
    ok = ok && count_members(g, o, log, err);
    for (size_t p = 0; p < presets; p++)
        for (int f = 0; ok && f < CONTEST_FIGURES; f++)
            ok = find_mean(o, log, g, (struct quantity){(enum contest_figure)f, p, p}, values,
                           &g->means[p * CONTEST_FIGURES + (size_t)f], err);
    for (size_t a = 0; a < presets; a++)
        for (size_t b = a + 1; b < presets; b++)
            for (size_t f = 0; ok && f < CONTEST_PAIRED; f++) {
                struct glint_figure *pair = &g->pairs[(a * presets + b) * CONTEST_PAIRED + f];
                ok = find_mean(o, log, g, (struct quantity){(enum contest_figure)f, a, b}, values, pair, err);
                g->pairs[(b * presets + a) * CONTEST_PAIRED + f] =
                    (struct glint_figure){-pair->value, -pair->high, -pair->low};
            }
    if (ok) g->best = find_best(g, presets);
    return ok;
}

/* ---- The worst captures ---- */

double contest_worst_error(const struct contest_log *log, size_t capture) {
    double worst = NAN;
    for (size_t p = 0; p < log->contest->count; p++)
        worst = fmax(worst, contest_log_figure(log, capture, p, CONTEST_ERROR)); /* which skips NAN */
    return worst;
}

struct ranked {
    size_t capture;
    double error;
    enum contest_state state;
};

static int compare_ranks(const void *one, const void *two) {
    const struct ranked *a = one, *b = two;
    const bool known_a = !isnan(a->error), known_b = !isnan(b->error);
    if ((a->state == CONTEST_DONE) != (b->state == CONTEST_DONE)) return a->state == CONTEST_DONE ? -1 : 1;
    if (known_a != known_b) return known_a ? -1 : 1;
    if (known_a && a->error != b->error) return a->error > b->error ? -1 : 1;
    return a->capture < b->capture ? -1 : a->capture > b->capture;
}

static bool rank(struct contest_overall *o, const struct contest_log *log, struct glint_error *err) {
    const size_t count = log->captures->count;
    struct ranked *ranks = malloc((count + 1) * sizeof *ranks);
    o->order = malloc((count + 1) * sizeof *o->order);
    const bool ok = (ranks && o->order) || fail_memory(err);
    for (size_t i = 0; ok && i < count; i++) ranks[i] = (struct ranked){i, contest_worst_error(log, i), log->states[i]};
    if (ok) qsort(ranks, count, sizeof *ranks, compare_ranks);
    for (size_t i = 0; ok && i < count; i++) {
        o->order[i] = ranks[i].capture;
        o->unreadable += ranks[i].state != CONTEST_DONE;
    }
    free(ranks);
    return ok;
}

bool contest_overall_find(struct contest_overall *o, const struct contest_log *log, struct glint_error *err) {
    *o = (struct contest_overall){0};
    double *values = malloc((log->captures->count + 1) * sizeof *values);
    bool ok = (values || fail_memory(err)) && number_shots(o, log->captures, err) &&
              find_groups(o, log->captures, err) && rank(o, log, err);
    for (size_t g = 0; ok && g < o->count; g++) ok = fill_group(&o->groups[g], o, log, values, err);
    free(values);
    return ok;
}

void contest_overall_finish(struct contest_overall *o) {
    for (size_t g = 0; o->groups && g < o->count; g++) {
        free(o->groups[g].means);
        free(o->groups[g].pairs);
    }
    free(o->groups);
    free(o->shots);
    free(o->order);
    *o = (struct contest_overall){0};
}
