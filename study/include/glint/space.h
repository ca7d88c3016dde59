/* Pipelines that differ in chosen parameters and variants: the points of a sweep, and which of them nothing beats. */
#ifndef GLINT_SPACE_H
#define GLINT_SPACE_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One thing that varies: NAMES=VALUES.
   NAMES: "slot.parameter", "pipeline.rays", or "slot" for its variant; several with '+' between them take the same value.
   VALUES: a list "a,b,c" of numbers, choices, variants; or a range of numbers
     a..b         of whole numbers each one, of others five
     a..b:STEP    a, a + STEP, … up to b
     a..b:log     a and its doubles below b, and b
     a..b:logN    N values from a to b, each the same ratio above the one before */
struct glint_space;
/* `axes` is NULL-terminated. Every value is checked against the declarations now; the message begins with the axis. Values
   that the chosen variant has no parameter for are left out: such points appear once. */
struct glint_space *glint_space_create(const struct glint_pipeline *base, const char *const *axes,
                                       struct glint_error *err);
/* Instead of the grid of all values: a Latin hypercube of `count` points. Each axis is cut into `count` strata, and each
   stratum is hit once; a list is gone through in turn. The same seed gives the same points. */
struct glint_space *glint_space_create_hypercube(const struct glint_pipeline *base, const char *const *axes,
                                                 uint32_t count, uint64_t seed, struct glint_error *err);
void glint_space_destroy(struct glint_space **space);

size_t glint_space_axis_count(const struct glint_space *space);
const char *glint_space_axis(const struct glint_space *space, size_t axis); /* its NAMES */
size_t glint_space_count(const struct glint_space *space);                  /* of points */
/* As it is assigned; "" where the point's variant has no such parameter. */
const char *glint_space_value(const struct glint_space *space, size_t point, size_t axis);
struct glint_pipeline *glint_space_pipeline(const struct glint_space *space, size_t point, struct glint_error *err);
/* Orders the points so that what late slots are given varies fastest, and neighbours share what runs before. `slots` in the
   order in which they run, NULL-terminated. */
bool glint_space_sort(struct glint_space *space, const char *const *slots, struct glint_error *err);

/* on[i]: no point is at most as high on both axes and lower on one; of equal points the first. Points with a NaN are never
   on the front. */
bool glint_pareto(const double *x, const double *y, size_t count, bool *on, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
