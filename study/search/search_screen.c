/* Screening: finds the axes of the largest effect with fewer points than single steps on all axes would take, by sequential bifurcation
   (B. Bettonvil and J. P. C. Kleijnen, "Searching for important factors in simulation models with many factors", 1997): all axes move
   together, and the group that changes the figures most is halved repeatedly. */
#include "search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Axes that moved together, and the logarithms of the factors by which both figures changed; infinite if the point was invalid. */
struct group {
    size_t first, count;
    double objective, constraint;
};

static double relative_change(double to, double from) {
    if (to > 0 && from > 0) return log(to / from);
    return from != 0 ? (to - from) / fabs(from) : to - from;
}

/* The relative change of both figures by a group, 0 if it is no larger than the noise. */
static double weight_of(const struct search *search, const struct group *group) {
    const double objective = fabs(group->objective), constraint = fabs(group->constraint);
    return (objective > 1e-9 ? objective : 0) + (constraint > search->options->noise + 1e-9 ? constraint : 0);
}

/* A value two steps lower, which usually lowers the cost, or higher if the range ends; or the next choice. */
static double moved_value(const struct glint_search_axis *axis, double from) {
    if (axis->choices) return (double)(((uint32_t)from + 1) % axis->choices);
    const double down = axis_move(axis, from, -2), up = axis_move(axis, from, 2);
    return isfinite(down) ? down : isfinite(up) ? up : from;
}

/* The point at which `count` axes from `first` on are moved. */
static void move_axes(const struct search *search, const double *centre, size_t first, size_t count, double *steps) {
    memcpy(steps, centre, search->count * sizeof *steps);
    for (size_t a = first; a < first + count; a++) steps[a] = moved_value(&search->axes[a], centre[a]);
}

/* *evaluated is false if max_points are used up. */
static bool measure_effects(struct search *search, const double *centre, const struct glint_search_figures *at,
                            struct group *group, double *steps, bool *evaluated, struct glint_error *err) {
    move_axes(search, centre, group->first, group->count, steps);
    const struct glint_search_point *point = search_at(search, steps, err);
    *evaluated = point != NULL;
    if (!point) return err->code == GLINT_OK;
    const bool answers = search_is_valid(&point->figures);
    group->objective = answers ? relative_change(point->figures.objective, at->objective) : INFINITY;
    group->constraint = answers ? relative_change(point->figures.constraint, at->constraint) : 0;
    return true;
}

/* Halves a group. The effect of the second half is the difference between those of the whole and of the first half, if these are known. */
static bool split_group(struct search *search, const double *centre, const struct glint_search_figures *at,
                        struct group *whole, struct group *rest, double *steps, bool *evaluated,
                        struct glint_error *err) {
    struct group half = {.first = whole->first, .count = whole->count / 2};
    *rest = (struct group){.first = half.first + half.count, .count = whole->count - half.count};
    if (!measure_effects(search, centre, at, &half, steps, evaluated, err) || !*evaluated) return err->code == GLINT_OK;
    if (isfinite(whole->objective) && isfinite(half.objective)) {
        rest->objective = whole->objective - half.objective;
        rest->constraint = whole->constraint - half.constraint;
    } else if (!measure_effects(search, centre, at, rest, steps, evaluated, err)) return false;
    else if (!*evaluated) rest->objective = INFINITY;
    *whole = half;
    *evaluated = true;
    return true;
}

static size_t heaviest_group(const struct search *search, const struct group *groups, size_t count) {
    size_t best = count;
    for (size_t g = 0; g < count; g++)
        if (groups[g].count > 1 && weight_of(search, &groups[g]) > 0 &&
            (best == count || weight_of(search, &groups[g]) > weight_of(search, &groups[best])))
            best = g;
    return best;
}

/* Announces the first halves of all groups that will be halved, if there are tries enough. */
static bool announce_halves(struct search *search, const double *centre, const struct group *groups, size_t count,
                            size_t last, double *steps, struct glint_error *err) {
    for (size_t g = 0; g < count && search->result->count + search->planned_count < last; g++) {
        if (groups[g].count < 2 || weight_of(search, &groups[g]) == 0) continue;
        move_axes(search, centre, groups[g].first, groups[g].count / 2, steps);
        if (!search_plan(search, steps, err)) return false;
    }
    return search_announce(search, err);
}

bool search_screen(struct search *search, const double *centre, const struct glint_search_figures *at, uint32_t tries,
                   double *weight, struct glint_error *err) {
    const size_t last = search->result->count + tries;
    struct group *groups = calloc(search->count + 1, sizeof *groups);
    double *steps = calloc(search->count + 1, sizeof *steps);
    size_t count = 1, g = 0;
    bool evaluated = true, ok = (groups && steps) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) {
        groups[0] = (struct group){.first = 0, .count = search->count};
        ok = measure_effects(search, centre, at, &groups[0], steps, &evaluated, err);
    }
    while (ok && evaluated && search->result->count < last && (g = heaviest_group(search, groups, count)) < count) {
        ok = announce_halves(search, centre, groups, count, last, steps, err) &&
             split_group(search, centre, at, &groups[g], &groups[count], steps, &evaluated, err);
        count += ok && evaluated;
    }
    for (size_t k = 0; ok && k < count; k++)
        for (size_t a = groups[k].first; a < groups[k].first + groups[k].count; a++)
            weight[a] = fmin(weight_of(search, &groups[k]), SEARCH_HEAVIEST) / (double)groups[k].count;
    free(steps);
    free(groups);
    return ok;
}
