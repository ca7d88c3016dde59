/* The evaluated points, the best of them, and those that are announced. */
#include "search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "no_memory.h"

void glint_search_result_finish(struct glint_search_result *result) {
    for (size_t i = 0; i < result->count; i++) free(result->points[i].values);
    free(result->points);
    free(result->matters);
    *result = (struct glint_search_result){0};
}

bool search_is_valid(const struct glint_search_figures *figures) {
    return isfinite(figures->objective) && isfinite(figures->constraint);
}

bool glint_search_better(const struct glint_search_figures *a, const struct glint_search_figures *b, double limit) {
    if (!search_is_valid(a) || !search_is_valid(b)) return search_is_valid(a) && !search_is_valid(b);
    const bool in = a->constraint <= limit, other = b->constraint <= limit;
    if (in != other) return in;
    if (in) return a->objective < b->objective || (a->objective == b->objective && a->constraint < b->constraint);
    return a->constraint < b->constraint || (a->constraint == b->constraint && a->objective < b->objective);
}

bool search_is_spent(const struct search *search) {
    return search->result->count >= search->options->max_points;
}

static bool add_point(struct search *search, const double *values, const struct glint_search_figures *figures,
                      struct glint_error *err) {
    struct glint_search_result *result = search->result;
    struct glint_search_point *larger = realloc(result->points, (result->count + 1) * sizeof *larger);
    if (!larger) return no_memory(err, "search");
    result->points = larger;
    struct glint_search_point point = {malloc((search->count + 1) * sizeof(double)), *figures};
    if (!point.values) return no_memory(err, "search");
    memcpy(point.values, values, search->count * sizeof(double));
    const size_t i = result->count++;
    result->points[i] = point;
    const double limit = search->options->limit, least = result->points[result->lowest].figures.constraint;
    if (glint_search_better(figures, &result->points[result->best].figures, limit)) result->best = i;
    if (search_is_valid(figures) && !(figures->constraint >= least)) result->lowest = i;
    result->feasible = result->points[result->best].figures.constraint <= limit;
    return true;
}

/* The evaluated point at `steps`, or NULL. In either case `scratch` receives its values. */
static const struct glint_search_point *find_point(struct search *search, const double *steps) {
    const struct glint_search_result *result = search->result;
    for (size_t i = 0; i < search->count; i++) search->scratch[i] = axis_value_at(&search->axes[i], steps[i]);
    for (size_t i = 0; i < result->count; i++)
        if (!memcmp(result->points[i].values, search->scratch, search->count * sizeof(double)))
            return &result->points[i];
    return NULL;
}

bool search_knows(struct search *search, const double *steps) {
    return find_point(search, steps) != NULL;
}

const struct glint_search_point *search_at(struct search *search, const double *steps, struct glint_error *err) {
    struct glint_search_result *result = search->result;
    struct glint_search_figures figures = {NAN, NAN};
    const struct glint_search_point *known = find_point(search, steps);
    if (known) return known;
    if (search_is_spent(search) || !search->evaluate(search->user, search->scratch, &figures, err) ||
        !add_point(search, search->scratch, &figures, err))
        return NULL;
    return &result->points[result->count - 1];
}

static bool is_planned(const struct search *search) {
    for (size_t i = 0; i < search->planned_count; i++)
        if (!memcmp(search->planned + i * search->count, search->scratch, search->count * sizeof(double))) return true;
    return false;
}

bool search_plan(struct search *search, const double *steps, struct glint_error *err) {
    if (!search->options->announce || search->result->count + search->planned_count >= search->options->max_points ||
        find_point(search, steps) || is_planned(search))
        return true;
    if (search->planned_count == search->planned_room) {
        const size_t room = 2 * search->planned_room + 8;
        double *larger = realloc(search->planned, room * (search->count + 1) * sizeof *larger);
        if (!larger) return no_memory(err, "search");
        search->planned = larger;
        search->planned_room = room;
    }
    memcpy(search->planned + search->planned_count++ * search->count, search->scratch, search->count * sizeof(double));
    return true;
}

bool search_announce(struct search *search, struct glint_error *err) {
    const size_t count = search->planned_count;
    search->planned_count = 0;
    return count < 2 || search->options->announce(search->user, search->planned, count, err);
}
