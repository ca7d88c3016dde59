/* Rays through cube maps of distances, each compared with a replay in double precision (cube_march.h) of the texels that the pass read.
   Ties are treated as in screen_rays.c. */
#ifndef GLINT_SELFTEST_CUBE_RAYS_H
#define GLINT_SELFTEST_CUBE_RAYS_H

#include "harness/replay_case.h"
#include "oracles/cube_march.h"
#include "oracles/plane_scene.h"

/* A room around the camera, and centres of cube maps in it, the first one at the camera; in world space. */
extern const double room_low[3], room_high[3], room_centers[CUBES_MOST][3];
double room_distance(uint32_t number, const double direction[3]);

#define CUBE_WORDS                                                                                                     \
    "downsample=none downsample.jitter=false screen_trace=linear screen_trace.dither=false cubemap_active=nearest "    \
    "cubemap_select=nearest "
#define CUBE_MARCH CUBE_WORDS "cubemap_trace=march cubemap_trace.random_scale=false "
#define CUBE_EXACT CUBE_WORDS "cubemap_trace=exact "
#define CUBE_ALONE "screen_trace.length_m=0 "
/* The unit of errors, and the reason for their bound. */
#define CUBE_UNIT "m, or of the distance"
/* clang-format off */
#define CUBE_REASON "a position is three sums of 2^-24 of its parts, a distance its square root; where a ray closes in on a surface slowly this grows, and the replays rounded otherwise say by how much"
/* clang-format on */

struct cube_rays {
    const struct march_rules *rules; /* NULL: the exact tracer with one cube map */
    double bound;
    enum plane_scene_rays rays;
    double depths_m[2]; /* of the surfaces where they start */
    bool rough;
    uint32_t width, height, cube_size, cube_count;
    void (*cube)(uint32_t number, const double direction[3], float out[5]); /* as in struct plain; or: */
    double (*distance)(uint32_t number, const double direction[3]);
    void (*sky)(const double direction[3], float out[3]);
    enum glint_volume volume;
};
/* Renders this many seeds through the run's pipeline. */
void cube_rays(struct case_run *run, const struct cube_rays *task, uint32_t seeds,
               struct glint_selftest_finding *finding);

#endif
