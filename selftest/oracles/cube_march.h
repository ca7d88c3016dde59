/* Rays through cube maps of distances in double precision: the march of cubemap_trace/march as its parameters say it, and
   the first place where a ray goes behind what cubemap_trace/exact takes the texels to show. */
#ifndef GLINT_SELFTEST_CUBE_MARCH_H
#define GLINT_SELFTEST_CUBE_MARCH_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/capture.h"

enum { CUBES_MOST = 4, CUBES_NO_PLACE = 255 };

/* The active cube maps, in their places. Positions are relative to the camera. */
struct cubes {
    uint32_t size, count;
    float *distance_m[CUBES_MOST]; /* six faces below each other */
    double center[CUBES_MOST][3];
    struct glint_cubemap maps[CUBES_MOST];
    uint32_t chain[CUBES_MOST][CUBES_MOST], longest;
    bool has_sky; /* a sky of its own */
    /* See depth_grid. */
    double rounding;
    uint32_t way;
};

struct cube_ray {
    double origin[3], direction[3], start_m;
    uint32_t best;
    bool rough;
};

struct cube_end {
    double t;
    uint32_t place, reason, steps;
};

/* Strides alone count, and grow shorter: 1.5 m (1 - 0.9^8) / (1 - 0.9) in all. */
#define STRIDES 8
#define STRIDE_RATIO 0.9
#define STRIDES_M 8.54299185
#define CUBE_STRIDES                                                                                                   \
    "cubemap_trace.count=strides cubemap_trace.steps_hq=8 cubemap_trace.first_step_m=1.5 "                             \
    "cubemap_trace.length_m=8.54299185 "

/* Parameters of cubemap_trace/march that cases change; the others are the defaults. */
struct march_rules {
    bool bilinear, secant, verify, step_back, skip_volume, radial;
    bool exact;   /* surfaces=exact */
    bool strides; /* of CUBE_STRIDES */
    enum { FALL_TO_NOTHING, FALL_TO_DIRECTION } fallback;
};
extern const struct march_rules march_rules_default;

struct cube_end cube_march(const struct cubes *cubes, const struct cube_ray *ray, const struct march_rules *rules);
/* Where the ray goes behind what the cube map `best` shows, for long enough that steps of half a texel must meet it; or, if
   that is sooner, at `found`, where that is within `by` of such a place: for less long it may, between texels of two walls. */
struct cube_end cube_exact(const struct cubes *cubes, const struct cube_ray *ray, double found, double by);

/* Of the cube map in `place`: distance in a direction that the exact tracer takes its texels to show. */
double cube_seen(const struct cubes *cubes, uint32_t place, const double direction[3]);

#endif
