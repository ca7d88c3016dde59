/* Mirror rays through a depth buffer, walked over every texel in double precision. Written from what the passes declare,
   in positions and depths; nothing of the shaders is used. */
#ifndef GLINT_SELFTEST_DEPTH_TRAVERSAL_H
#define GLINT_SELFTEST_DEPTH_TRAVERSAL_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/capture.h"

/* A depth buffer at full resolution: depth_m per texel, normal X Y Z and roughness, in world space. */
struct depth_grid {
    uint32_t width, height;
    const float *depth_m, *normal;
    double rows[3][3];         /* world to view */
    double scale[2], shift[2]; /* uv = view/depth · scale + shift */
    double front, near_m;      /* sign of view z in front */
    /* By how much rounding may move what decides, a part of the depth for each unit that went into it; and which of all
       ways in which it may. 0 at first: exact. */
    double rounding;
    uint32_t way;
};
void depth_grid_init(struct depth_grid *grid, const struct glint_frame *frame, uint32_t width, uint32_t height,
                     const float *depth_m, const float *normal);

struct depth_ray {
    double origin[3], direction[3]; /* view, direction of unit length */
    uint32_t x, y;
};
/* False when the texel has no ray. */
bool depth_ray_init(struct depth_ray *ray, const struct depth_grid *grid, uint32_t x, uint32_t y);
/* Place in texels of the ray's point at distance t; false behind the viewer. */
bool depth_ray_project(const struct depth_grid *grid, const struct depth_ray *ray, double t, double place[2],
                       double *depth_m);
/* Parts of the inverse depth by which it changes over a texel. */
void depth_grid_slopes(const struct depth_grid *grid, uint32_t x, uint32_t y, double slopes[2]);
/* What rounding moves a number by that units went into. */
double depth_grid_rounding(const struct depth_grid *grid, double units, uint32_t number);
/* Angle that a texel spans in the middle of the picture. */
double depth_grid_texel_angle(const struct depth_grid *grid);

/* One texel that a ray crosses, from distance t_in to t_out; t_out is at most the end. */
struct depth_cell {
    uint32_t x, y;
    double t_in, t_out;
    double gap_in, gap_out; /* depth of the ray less depth of the surface there, over the latter: positive behind */
    bool own;               /* where the ray starts */
    double rise;            /* what went into the gaps: 1 and what the texel's plane rises up to here */
    double depth_m, steep;  /* at the centre; the sum of both slopes' amounts */
};
/* Calls `visit` for every texel, its own first, until it returns false. Returns the distance where the walk ended. */
double depth_ray_traverse(const struct depth_grid *grid, const struct depth_ray *ray, double length_m,
                          bool (*visit)(void *user, const struct depth_cell *cell), void *user);

/* The rules of screen_trace/dda, as its parameters say them. */
struct traversal_rules {
    double thickness, thickness_m, seam, jump, solid, bias, length_m;
    bool sky, pass_behind;
};
extern const struct traversal_rules traversal_rules_default;
/* Why the ray ends (end_reason_names.h), and its distance: of a ray that hits nothing, where it was last in front of all. */
uint32_t traversal_end(const struct depth_grid *grid, const struct depth_ray *ray, const struct traversal_rules *rules,
                       double *t);
/* The same ray with its direction rounded differently, by up to `by` in each component. */
struct depth_ray depth_ray_rounded(const struct depth_ray *ray, double by, uint32_t way);
/* True for a hit; then *t is its distance. */
bool traversal_hit(const struct depth_grid *grid, const struct depth_ray *ray, const struct traversal_rules *rules,
                   double *t);

#endif
