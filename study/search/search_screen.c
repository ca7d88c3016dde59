/* Screening: with fewer tries than single steps would take, which axes are worth looking at one by one. Sequential bifurcation
   (B. Bettonvil and J. P. C. Kleijnen, "Searching for important factors in simulation models with many factors", 1997): all
   axes move together, and the group that changes the figures most is halved, again and again. */
#include "search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Axes that moved together, and by which factors (as logarithms) both figures changed; infinite when there was no answer. */
struct group {
    size_t first, count;
    double wanted, limited;
};

static double factor(double to, double from) {
    if (to > 0 && from > 0) return log(to / from);
    return from != 0 ? (to - from) / fabs(from) : to - from;
}

/* 0: the axes change nothing, or no more than noise. */
static double weight_of(const struct search *search, const struct group *group) {
    const double wanted = fabs(group->wanted), limited = fabs(group->limited);
    return (wanted > 1e-9 ? wanted : 0) + (limited > search->options->noise + 1e-9 ? limited : 0);
}

/* Two steps down, which is where costs are saved; up where the range ends; the next choice. */
static double moved(const struct glint_search_axis *axis, double from) {
    if (axis->choices) return (double)(((uint32_t)from + 1) % axis->choices);
    const double down = axis_move(axis, from, -2), up = axis_move(axis, from, 2);
    return isfinite(down) ? down : isfinite(up) ? up : from;
}

/* *tried: there was a try left for it. */
static bool measure_effects(struct search *search, const double *centre, const struct glint_search_figures *at,
                            struct group *group, double *steps, bool *tried, struct glint_error *err) {
    memcpy(steps, centre, search->count * sizeof *steps);
    for (size_t a = group->first; a < group->first + group->count; a++) steps[a] = moved(&search->axes[a], centre[a]);
    const struct glint_search_point *point = search_at(search, steps, err);
    *tried = point != NULL;
    if (!point) return err->code == GLINT_OK;
    const bool answers = search_answers(&point->figures);
    group->wanted = answers ? factor(point->figures.wanted, at->wanted) : INFINITY;
    group->limited = answers ? factor(point->figures.limited, at->limited) : 0;
    return true;
}

/* The second half is what the first leaves of the whole, as far as that is known. */
static bool split(struct search *search, const double *centre, const struct glint_search_figures *at,
                  struct group *whole, struct group *rest, double *steps, bool *tried, struct glint_error *err) {
    struct group half = {.first = whole->first, .count = whole->count / 2};
    *rest = (struct group){.first = half.first + half.count, .count = whole->count - half.count};
    if (!measure_effects(search, centre, at, &half, steps, tried, err) || !*tried) return err->code == GLINT_OK;
    if (isfinite(whole->wanted) && isfinite(half.wanted)) {
        rest->wanted = whole->wanted - half.wanted;
        rest->limited = whole->limited - half.limited;
    } else if (!measure_effects(search, centre, at, rest, steps, tried, err)) return false;
    else if (!*tried) rest->wanted = INFINITY;
    *whole = half;
    *tried = true;
    return true;
}

static size_t heaviest(const struct search *search, const struct group *groups, size_t count) {
    size_t best = count;
    for (size_t g = 0; g < count; g++)
        if (groups[g].count > 1 && weight_of(search, &groups[g]) > 0 &&
            (best == count || weight_of(search, &groups[g]) > weight_of(search, &groups[best])))
            best = g;
    return best;
}

bool search_screen(struct search *search, const double *centre, const struct glint_search_figures *at, uint32_t tries,
                   double *weight, struct glint_error *err) {
    const size_t last = search->result->count + tries;
    struct group *groups = calloc(search->count + 1, sizeof *groups);
    double *steps = calloc(search->count + 1, sizeof *steps);
    size_t count = 1, g = 0;
    bool tried = true, ok = (groups && steps) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) {
        groups[0] = (struct group){.first = 0, .count = search->count};
        ok = measure_effects(search, centre, at, &groups[0], steps, &tried, err);
    }
    while (ok && tried && search->result->count < last && (g = heaviest(search, groups, count)) < count) {
        ok = split(search, centre, at, &groups[g], &groups[count], steps, &tried, err);
        count += ok && tried;
    }
    for (size_t k = 0; ok && k < count; k++)
        for (size_t a = groups[k].first; a < groups[k].first + groups[k].count; a++)
            weight[a] = fmin(weight_of(search, &groups[k]), SEARCH_HEAVIEST) / (double)groups[k].count;
    free(steps);
    free(groups);
    return ok;
}
