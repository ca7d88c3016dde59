/* The march of screen_trace/linear in double precision, in distances and depths as its parameters say them. */
#ifndef GLINT_VIEWER_STEPPED_H
#define GLINT_VIEWER_STEPPED_H

#include "walk.h"

struct step_rules {
    uint32_t steps;
    double growth, thickness, bias, length_m;
    bool pass_behind, back_faces, interpolate, refine, verify, sky;
};
extern const struct step_rules step_rules_default;
/* Why the ray ends (ends.h), and its distance. */
uint32_t stepped_end(const struct walk_grid *grid, const struct walk_ray *ray, const struct step_rules *rules,
                     double *t);

#endif
