/* How far the rounding of a capture's values moves what passes make of them. docs/stability.md states every definition. */
#ifndef GLINT_STABILITY_H
#define GLINT_STABILITY_H

#include "glint/study.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A frame is replayed as it is, and once for each seed with values that the engine may as well have had in mind
   (glint_capture_perturb). */
struct glint_stability_options {
    uint32_t seeds;            /* 0: GLINT_STABILITY_SEEDS; at most 255 */
    const char *const *inputs; /* what is perturbed: as of glint_capture_perturb; NULL: all */
    bool half;                 /* images in their own formats, whose rounding then counts too; false: all in float */
    bool all;                  /* as in struct glint_replay_options */
    const char *const *skip;   /* likewise */
    double bound;              /* amplification above this is ill-conditioned; 0: GLINT_STABILITY_BOUND */
};
enum { GLINT_STABILITY_SEEDS = 8, GLINT_STABILITY_WORST = 5 };
#define GLINT_STABILITY_BOUND 10.0
#define GLINT_STABILITY_LEAST 0.01 /* an input's change at a pixel counts as no less than this part of the frame's */

struct glint_stability_pixel {
    uint32_t x, y; /* of the image */
    double amplification, change;
    float before[4];
};
struct glint_stability_summary {
    uint64_t compared, above; /* above the bound */
    double median, p99, largest;
};
struct glint_stability_image {
    const char *name;
    const struct glint_pass *pass; /* NULL: of the capture, with `change` alone */
    const struct glint_row *row;
    uint32_t width, height, components;
    bool over_picture; /* its texels are pixels, or blocks of them */
    bool decides;      /* whole numbers: choices, such as why a ray ended. It has `flips` alone */
    /* A value a texel, NULL where there is none. */
    float *change;        /* root mean square of the relative change, over the seeds that decided alike */
    float *amplification; /* that over the same of its inputs */
    uint8_t *flips;       /* how many seeds decided otherwise */
    struct glint_stability_summary summary; /* of amplification; of the change for the capture's own */
    uint64_t flipped;                       /* compared texels that some seed decided otherwise */
    double flip_share;                      /* of texels, in the mean of the seeds */
    struct glint_stability_pixel worst[GLINT_STABILITY_WORST];
    size_t worst_count;
    /* Forecast of overflow: the largest finite magnitude, of the frame as it is. */
    double peak;
    uint32_t peak_x, peak_y, peak_component;
    uint64_t beyond, invalid; /* values larger than 65504; NaN, and infinite ones but distances */
};
struct glint_stability_pass {
    const struct glint_pass *pass;
    size_t place;                           /* among all that the plan names, from 1: that of its file in a run */
    struct glint_stability_summary summary; /* each pixel's largest amplification of its images */
    uint64_t starts;                        /* pixels in which no earlier pass is above the bound */
    uint64_t flipped, ends, flip_starts;    /* pixels that decide otherwise in some seed; whose end reason does; here
                                               first */
};
struct glint_stability {
    uint32_t seeds, width, height;
    double bound;
    struct glint_stability_image *images; /* the capture's first, then in the order of the passes; finest levels */
    size_t image_count;
    struct glint_stability_pass *passes; /* those that ran on the device and made images over the picture */
    size_t pass_count;
    uint32_t *start; /* a pixel: the place of the pass that is above the bound first; 0: none */
    uint32_t *flip_start;
    float *amplification; /* a pixel: of the picture that the last pass makes */
};
/* Loads the capture into the replay, perturbed anew for each seed, and leaves it as it is. A frame whose perturbed values
   call for other passes is an error. */
bool glint_stability_measure(struct glint_replay *replay, struct glint_capture *capture,
                             const struct glint_pipeline *pipeline, const struct glint_stability_options *options,
                             glint_progress progress, void *user, struct glint_stability *stability,
                             struct glint_error *err);
void glint_stability_finish(struct glint_stability *stability);

#ifdef __cplusplus
}
#endif
#endif
