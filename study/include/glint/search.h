/* Constrained optimisation: finds the values of numbers and choices that minimise an objective while a constraint stays within a limit.
   It is independent of what the figures measure. */
#ifndef GLINT_SEARCH_H
#define GLINT_SEARCH_H

#include <stddef.h>
#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

enum glint_search_scale {
    GLINT_SEARCH_LINEAR,  /* a step is an eighth of the range */
    GLINT_SEARCH_DOUBLING /* a step doubles the distance to the lowest value, offset by a small constant if that is 0 */
};
struct glint_search_axis {
    double lowest, highest, start; /* start lies within the range */
    uint32_t choices; /* if not 0, the values are 0 … choices - 1 without an order, and range and scale do not apply */
    bool whole;       /* whole numbers only */
    bool keep; /* is searched even if it changes nothing around the start, since it may matter when other axes change */
    enum glint_search_scale scale;
};
/* The suitable scale of a range: doubling if the range spans decades around its start. */
enum glint_search_scale glint_search_scale(double lowest, double highest, double start);

/* The figures of a point. NAN marks an invalid point. */
struct glint_search_figures {
    double objective;  /* to be minimised */
    double constraint; /* must not exceed the limit */
};
/* Evaluates a point, given as one value an axis within its range. Called once for each point. False with an error ends the search. */
typedef bool (*glint_search_evaluate)(void *user, const double *values, struct glint_search_figures *figures,
                                      struct glint_error *err);
/* Announces points that are evaluated next, one value an axis, one point after the other: several threads or processes may evaluate them at the same time,
   before the search asks for the first. It asks for them in this order, but for screened groups; points may be announced again. A few of them are never asked
   for: when the points before them end what the search tries, or use up max_points. False with an error ends the search. */
typedef bool (*glint_search_announce)(void *user, const double *values, size_t count, struct glint_error *err);
struct glint_search_options {
    double limit;
    uint32_t max_points; /* the maximum number of points to evaluate, the start and the initial points included */
    uint64_t seed;       /* the same seed and figures give the same points in the same order */
    double noise;        /* relative changes of the constraint up to this are insignificant; 0: it is exact */
    /* Values of `initial_count` points, one point after the other, that are evaluated right after the start. The result is at least as
       good as each of them. */
    const double *initial;
    size_t initial_count;
    glint_search_announce announce; /* or NULL: the search is the same without it */
};

struct glint_search_point {
    double *values;
    struct glint_search_figures figures;
};
struct glint_search_result {
    size_t axes;
    struct glint_search_point *points; /* all evaluated points, in order */
    size_t count;
    size_t best, lowest; /* the best point, which may exceed the limit; the point with the lowest constraint */
    bool feasible;       /* the best point is within the limit */
    bool *matters;       /* for each axis: some value changed a figure; true also if that could not be evaluated */
};
void glint_search_result_finish(struct glint_search_result *result);
/* Whether `a` is better than `b`: a feasible point by its objective, an infeasible one by its constraint. */
bool glint_search_better(const struct glint_search_figures *a, const struct glint_search_figures *b, double limit);

/* The search evaluates steps of two, one, half … on every axis around the best point. The changes of single steps predict those of
   combined steps, and the combination that is predicted best within the limit, found by a Lagrange multiplier, is evaluated next. A
   direction that improves the best point is followed further (R. Hooke and T. A. Jeeves, "Direct search", 1961). When that no longer
   improves it, COBYLA (M. J. D. Powell, "A direct search optimization method that models the objective and constraint functions by
   linear interpolation", 1994; from NLopt) continues over the numbers, and then the search restarts from a random displacement of the
   best point. If max_points do not suffice for the first steps on all axes, groups of axes are screened first, and steps begin with the
   axes of the largest effect. Steps, screened groups and simplified combinations are announced together; what COBYLA and the search along a direction ask for
   depends on each point before. After an error `result` holds what was found so far; release it in any case. */
bool glint_search(const struct glint_search_axis *axes, size_t count, const struct glint_search_options *options,
                  glint_search_evaluate try_point, void *user, struct glint_search_result *result,
                  struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
