/* The march of screen_trace/linear in double precision, in distances and depths as its parameters say them. */
#ifndef GLINT_SELFTEST_DEPTH_MARCH_H
#define GLINT_SELFTEST_DEPTH_MARCH_H

#include "oracles/depth_traversal.h"

struct depth_march_rules {
    uint32_t steps;
    double growth, thickness, bias, length_m;
    bool pass_behind, back_faces, interpolate, refine, verify, sky;
};
extern const struct depth_march_rules depth_march_rules_default;
/* Why the ray ends (end_reason_names.h), and its distance. */
uint32_t depth_march_end(const struct depth_grid *grid, const struct depth_ray *ray,
                         const struct depth_march_rules *rules, double *t);

#endif
