/* Mirror rays through a depth buffer, walked over every texel in double precision. Written from what the passes declare,
   in positions and depths; nothing of the shaders is used. */
#ifndef GLINT_VIEWER_WALK_H
#define GLINT_VIEWER_WALK_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/capture.h"

/* A depth buffer at full resolution: depth_m per texel, normal X Y Z and roughness, world axes. */
struct walk_grid {
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
void walk_grid_init(struct walk_grid *grid, const struct glint_frame *frame, uint32_t width, uint32_t height,
                    const float *depth_m, const float *normal);

struct walk_ray {
    double origin[3], direction[3]; /* view, direction of unit length */
    uint32_t x, y;
};
/* False when the texel has no ray. */
bool walk_ray_init(struct walk_ray *ray, const struct walk_grid *grid, uint32_t x, uint32_t y);
/* Place in texels of the ray's point at distance t; false behind the viewer. */
bool walk_project(const struct walk_grid *grid, const struct walk_ray *ray, double t, double place[2], double *depth_m);
/* Parts of the inverse depth by which it changes over a texel. */
void walk_slopes(const struct walk_grid *grid, uint32_t x, uint32_t y, double slopes[2]);
/* What rounding moves a number by that units went into. */
double walk_rounding(const struct walk_grid *grid, double units, uint32_t number);
/* Angle that a texel spans in the middle of the picture. */
double walk_texel_angle(const struct walk_grid *grid);

/* One texel that a ray crosses, from distance t_in to t_out; t_out is at most the end. */
struct walk_cell {
    uint32_t x, y;
    double t_in, t_out;
    double gap_in, gap_out; /* depth of the ray less depth of the surface there, over the latter: positive behind */
    bool own;               /* where the ray starts */
    double rise;            /* what went into the gaps: 1 and what the texel's plane rises up to here */
    double depth_m, steep;  /* at the centre; the sum of both slopes' amounts */
};
/* Calls `visit` for every texel, its own first, until it returns false. Returns the distance where the walk ended. */
double walk(const struct walk_grid *grid, const struct walk_ray *ray, double length_m,
            bool (*visit)(void *user, const struct walk_cell *cell), void *user);

/* The rules of screen_trace/dda, as its parameters say them. */
struct walk_rules {
    double thickness, thickness_m, seam, jump, solid, bias, length_m;
    bool sky, pass_behind;
};
extern const struct walk_rules walk_rules_default;
/* Why the ray ends (ends.h), and its distance: of a ray that hits nothing, where it was last in front of all. */
uint32_t walk_end(const struct walk_grid *grid, const struct walk_ray *ray, const struct walk_rules *rules, double *t);
/* The same ray with its direction rounded another way, by up to `by` in each component. */
struct walk_ray walk_ray_rounded(const struct walk_ray *ray, double by, uint32_t way);
/* True for a hit; then *t is its distance. */
bool walk_trace(const struct walk_grid *grid, const struct walk_ray *ray, const struct walk_rules *rules, double *t);

#endif
