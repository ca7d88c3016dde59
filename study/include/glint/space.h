/* Parameter spaces: pipelines that differ in chosen parameters and variants, which are the points of a sweep, and Pareto fronts. */
#ifndef GLINT_SPACE_H
#define GLINT_SPACE_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An axis is written as NAMES=VALUES.
   NAMES: "slot.parameter", "pipeline.rays", or "slot" for its variant. Several names joined by '+' take the same value.
   VALUES: a list "a,b,c" of numbers, choices or variants, or a range of numbers
     a..b         every whole number, or five values of a fractional parameter
     a..b:STEP    a, a + STEP, … up to b
     a..b:log     a, 2a, 4a, … below b, and b
     a..b:logN    N values from a to b with equal ratios */
struct glint_space;
/* The grid of all values of the axes, which are NULL-terminated. Every value is checked against the declarations; the error message
   begins with the axis. If a point's variant does not have a parameter, its values are left out and the point appears only once. */
struct glint_space *glint_space_create(const struct glint_pipeline *base, const char *const *axes,
                                       struct glint_error *err);
/* A Latin hypercube of `count` points instead of the grid. Each axis is cut into `count` strata, each of which holds one point; the
   values of a list occur equally often. The same seed gives the same points. */
struct glint_space *glint_space_create_hypercube(const struct glint_pipeline *base, const char *const *axes,
                                                 uint32_t count, uint64_t seed, struct glint_error *err);
void glint_space_destroy(struct glint_space **space);

size_t glint_space_axis_count(const struct glint_space *space);
const char *glint_space_axis(const struct glint_space *space, size_t axis); /* its NAMES */
size_t glint_space_count(const struct glint_space *space);                  /* number of points */
/* The value as text; "" if the point's variant has no such parameter. */
const char *glint_space_value(const struct glint_space *space, size_t point, size_t axis);
struct glint_pipeline *glint_space_pipeline(const struct glint_space *space, size_t point, struct glint_error *err);
/* Sorts the points so that values of late slots vary fastest and neighbouring points share the work of earlier slots. `slots` lists
   the slots in order of execution, NULL-terminated. */
bool glint_space_sort(struct glint_space *space, const char *const *slots, struct glint_error *err);

/* Sets on[i] if point i is on the Pareto front: no other point is at most as high in x and y and lower in one of them. Of equal points
   only the first is on the front, and points with a NaN never are. */
bool glint_pareto(const double *x, const double *y, size_t count, bool *on, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
