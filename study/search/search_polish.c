/* Polishes numeric axes by COBYLA from NLopt. */
#include "search.h"

#include <math.h>
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

struct polish {
    struct search *search;
    nlopt_opt solver;
    double *steps; /* position on all axes; that on the polished axes changes */
    const size_t *axes;
    size_t count;
    struct glint_search_figures scale;
    struct glint_error *err;
};

/* The figures at x. The solver is stopped if max_points are used up. */
static struct glint_search_figures figures_at(struct polish *polish, const double *x) {
    for (size_t i = 0; i < polish->count; i++) polish->steps[polish->axes[i]] = x[i];
    const struct glint_search_point *point = search_at(polish->search, polish->steps, polish->err);
    if (!point) nlopt_force_stop(polish->solver);
    return point && isfinite(point->figures.objective) && isfinite(point->figures.constraint)
               ? point->figures
               : (struct glint_search_figures){1e6 * polish->scale.objective, 1e6 * polish->scale.constraint};
}

static double objective_at(unsigned count, const double *x, double *gradient, void *user) {
    struct polish *polish = user;
    (void)count;
    (void)gradient;
    return figures_at(polish, x).objective / polish->scale.objective;
}

static double constraint_at(unsigned count, const double *x, double *gradient, void *user) {
    struct polish *polish = user;
    (void)count;
    (void)gradient;
    return (figures_at(polish, x).constraint - polish->search->options->limit) / polish->scale.constraint;
}

bool search_polish(struct search *search, const double *centre, const size_t *axes, size_t count, uint32_t tries,
                   struct glint_error *err) {
    const struct glint_search_figures *best = &search->result->points[search->result->best].figures;
    struct polish polish = {.search = search,
                            .solver = nlopt_create(NLOPT_LN_COBYLA, (unsigned)count),
                            .steps = calloc(search->count + 1, sizeof(double)),
                            .axes = axes,
                            .count = count,
                            .scale = {fabs(best->objective) + 1e-30, fabs(best->constraint) + 1e-30},
                            .err = err};
    double *values = calloc(3 * count + 1, sizeof *values), *low = values, *high = low + count, *x = high + count;
    bool ok = polish.solver && polish.steps && values;
    if (ok) {
        memcpy(polish.steps, centre, search->count * sizeof *centre);
        for (size_t i = 0; i < count; i++) {
            high[i] = axis_length(&search->axes[axes[i]]);
            x[i] = fmin(fmax(centre[axes[i]], 0), high[i]);
        }
        double answer;
        ok = nlopt_set_min_objective(polish.solver, objective_at, &polish) > 0 &&
             nlopt_add_inequality_constraint(polish.solver, constraint_at, &polish, 0) > 0 &&
             nlopt_set_lower_bounds(polish.solver, low) > 0 && nlopt_set_upper_bounds(polish.solver, high) > 0 &&
             nlopt_set_initial_step1(polish.solver, 0.5) > 0 && nlopt_set_xtol_abs1(polish.solver, 0.01) > 0 &&
             nlopt_set_maxeval(polish.solver, (int)tries) > 0;
        /* The result does not matter, since search_at keeps all points. */
        if (ok) nlopt_optimize(polish.solver, x, &answer);
    }
    if (polish.solver) nlopt_destroy(polish.solver);
    free(values);
    free(polish.steps);
    return ok ? err->code == GLINT_OK : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}
