/* Runs the search from the start and the baseline. */
#include <stdlib.h>

#include "tune/tune.h"

static struct glint_search_figures as_searched(const struct tune *tune, struct tune_figures found) {
    return (struct glint_search_figures){tune->by_error ? found.cost : found.error,
                                         tune->by_error ? found.error : found.cost};
}

static bool try_values(void *user, const double *values, struct glint_search_figures *figures,
                       struct glint_error *err) {
    const struct tune *tune = user;
    struct tune_figures found;
    if (!tune_evaluate(user, values, &found, err)) return false;
    *figures = as_searched(tune, found);
    return true;
}

/* Evaluates the start and the baseline, which define the norm and the limit. */
static bool begin_search(struct tune *tune, const double *start, struct glint_error *err) {
    if (!tune_evaluate(tune, start, &tune->start, err)) return false;
    tune_set_norm(tune, start);
    tune->asked = tune->limit * (tune->part ? (tune->by_error ? tune->start.error : tune->start.cost) : 1);
    tune->within = tune->asked;
    return !tune->baseline || (tune_find_scale(tune, err) && tune_evaluate(tune, start, &tune->start, err));
}

/* `known`: `count` points, one after the other, from which the search continues. */
static bool search(struct tune *tune, uint32_t tries, const double *known, size_t count, struct glint_error *err) {
    enum { NOISE_PER_CENT = 2 };
    const struct glint_search_options options = {.limit = tune->within,
                                                 .max_points = tries,
                                                 .seed = tune->seed,
                                                 .noise = tune->fetches ? 0 : NOISE_PER_CENT * 0.01,
                                                 .initial = known,
                                                 .initial_count = count,
                                                 .announce = tune_announce};
    struct glint_search_axis *axes = calloc(tune->axis_count + 1, sizeof *axes);
    if (!axes) return fail_memory(err);
    for (size_t a = 0; a < tune->axis_count; a++) {
        axes[a] = tune->axes[a].axis;
        axes[a].keep = tune->axes[a].other;
    }
    glint_search_result_finish(&tune->found);
    const bool ok = glint_search(axes, tune->axis_count, &options, try_values, tune, &tune->found, err);
    tune->chosen = tune->found.best;
    free(axes);
    return ok;
}

bool tune_search(struct tune *tune, struct glint_error *err) {
    progress_phase(tune->progress, "search");
    double *start = calloc(tune->axis_count + 1, sizeof *start);
    for (size_t a = 0; start && a < tune->axis_count; a++) start[a] = tune->axes[a].axis.start;
    const bool ok =
        start ? begin_search(tune, start, err) && search(tune, tune->tries, tune->scaling, tune->baseline, err)
              : fail_memory(err);
    free(start);
    return ok;
}

bool tune_search_again(struct tune *tune, double part, const double *parts, struct glint_error *err) {
    double *known = NULL;
    size_t count = 0;
    tune_correct(tune, tune->found.points[tune->chosen].values, part, parts);
    const bool ok =
        tune_all_tried(tune, &known, &count, err) && search(tune, (uint32_t)count + tune->tries / 4, known, count, err);
    free(known);
    return ok;
}
