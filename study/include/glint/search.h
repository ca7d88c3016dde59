/* Finds values of numbers and choices that make one figure least while another stays within a limit. Knows nothing of
   what is measured. */
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
    GLINT_SEARCH_DOUBLING /* a step doubles what is above the lowest value, near zero by a small constant */
};
struct glint_search_axis {
    double lowest, highest, start; /* start lies within the range */
    uint32_t choices; /* not 0: it takes 0 … choices - 1, which have no order; no range and no scale then */
    bool whole;
    bool
        hidden; /* it may begin to matter when others change: it is not left alone for changing nothing around the start */
    enum glint_search_scale scale;
};
/* The scale that suits a range: doubling where it spans decades, seen from its start. */
enum glint_search_scale glint_search_scale(double lowest, double highest, double start);

/* NAN: such a point is no answer. */
struct glint_search_figures {
    double wanted;  /* to be least */
    double limited; /* to be at most the limit */
};
/* One value an axis, each within its range. Called once a point. False with an error ends the search. */
typedef bool (*glint_search_try)(void *user, const double *values, struct glint_search_figures *figures,
                                 struct glint_error *err);
struct glint_search_options {
    double limit;
    uint32_t tries; /* points that may be tried, at most; the first is the start, then come the known ones */
    uint64_t seed;  /* the same seed and the same figures: the same points in the same order */
    double noise;   /* relative changes of `limited` up to this say nothing; 0: it is exact */
    const double
        *known; /* values of points that are tried first, one after the other, so that nothing worse is found */
    size_t known_count;
};

struct glint_search_point {
    double *values;
    struct glint_search_figures figures;
};
struct glint_search_result {
    size_t axes;
    struct glint_search_point *points; /* all that were tried, in order */
    size_t count;
    size_t best, least; /* the best, which may be beyond the limit; the one whose `limited` is least */
    bool within;        /* best is within the limit */
    bool *matters;      /* one an axis: some value changed a figure; true also where there was no try left for it */
};
void glint_search_result_finish(struct glint_search_result *result);
/* Whether `a` is the better answer: within the limit by what is wanted, beyond it by what is limited. */
bool glint_search_better(const struct glint_search_figures *a, const struct glint_search_figures *b, double limit);

/* Steps of two, one, half … on every axis around the best point; what they change alone predicts what they change together,
   and the best sum within the limit is tried (a Lagrangian multiplier finds it), and what gains is gone on with (R. Hooke and T. A.
   Jeeves, "Direct search", 1961). When that gains no more, COBYLA (M. J. D.
   Powell, "A direct search optimization method that models the objective and constraint functions by linear
   interpolation", 1994; from NLopt) goes on over the numbers, and then the search starts again from the best point, thrown off it at
   random. With fewer tries than the first steps on every axis take, groups of axes are screened for what they change together, and
   the first steps are those of the axes that weigh most. `result` holds what was found until an error, too; finish it in any case. */
bool glint_search(const struct glint_search_axis *axes, size_t count, const struct glint_search_options *options,
                  glint_search_try try_point, void *user, struct glint_search_result *result, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
