/* Numerical stability: how much the rounding of a capture's values changes the images that passes make of them. docs/stability.md
   states every definition. */
#ifndef GLINT_STABILITY_H
#define GLINT_STABILITY_H

#include "glint/study.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A frame is replayed unperturbed, and once for each seed with its values perturbed by their rounding error (glint_capture_perturb). */
struct glint_stability_options {
    const struct glint_effect *effect; /* whose judged pixels are compared; NULL: the first of glint_effects() */
    uint32_t seeds;                    /* 0: GLINT_STABILITY_SEEDS; at most 255 */
    const char *const *inputs;         /* the values to perturb: `only` of glint_capture_perturb; NULL: all */
    bool half;               /* images keep their formats, so that rounding to half counts, too; false: all are float */
    bool all;                /* as in struct glint_replay_options */
    const char *const *skip; /* as in struct glint_replay_options */
    double bound;            /* amplification above this counts as ill-conditioned; 0: GLINT_STABILITY_BOUND */
};
enum { GLINT_STABILITY_SEEDS = 8, GLINT_STABILITY_WORST = 5 };
#define GLINT_STABILITY_BOUND 10.0
/* The change of an input at a pixel counts as at least this fraction of its change over the frame. */
#define GLINT_STABILITY_LEAST 0.01

struct glint_stability_pixel {
    uint32_t x, y; /* texel of the image */
    double amplification, change;
    float before[4]; /* its unperturbed value */
};
struct glint_stability_summary {
    uint64_t compared, above; /* number of texels, and of those above the bound */
    double median, p99, largest;
};
struct glint_stability_image {
    const char *name;
    const struct glint_pass *pass; /* NULL for an image of the capture, which has `change` but no amplification */
    const struct glint_row *row;
    uint32_t width, height, components;
    bool per_pixel; /* each texel belongs to a pixel, or a block of pixels, of the picture */
    bool discrete;  /* integers that encode a decision, such as why a ray ended; only `flips` applies to them */
    /* One value a texel, or NULL. */
    float *change;        /* root mean square of the relative change, over the seeds in which no decision flipped */
    float *amplification; /* `change` divided by the same of the image's inputs */
    uint8_t *flips;       /* number of seeds in which a decision differs from the unperturbed frame's */
    struct glint_stability_summary summary; /* of amplification; of `change` for an image of the capture */
    uint64_t flipped;                       /* number of compared texels that flip in some seed */
    double flip_share;                      /* fraction of texels that flip, as a mean over the seeds */
    struct glint_stability_pixel worst[GLINT_STABILITY_WORST];
    size_t worst_count;
    /* Distance to overflow in half: the largest finite magnitude of the unperturbed frame, and where it is. */
    double peak;
    uint32_t peak_x, peak_y, peak_component;
    uint64_t overflowing, invalid; /* finite values beyond 65504; NaN, and infinite values except distances */
};
struct glint_stability_pass {
    const struct glint_pass *pass;
    size_t place;                           /* number of the pass in the plan and of its file in a run, from 1 */
    struct glint_stability_summary summary; /* of each pixel's largest amplification over the pass's images */
    uint64_t starts;                        /* pixels where this pass is the first above the bound */
    /* Pixels where a decision of the pass flips in some seed, where an end reason does, where this pass is the first that flips. */
    uint64_t flipped, ends, flip_starts;
};
/* Values of an image of the unperturbed frame that are not finite (in lengths: NaN), or that are clamped to the range of half. */
struct glint_stability_invalid {
    char image[96], channel[48];   /* image: "" if there are none */
    const struct glint_pass *pass; /* NULL for the capture */
    uint32_t x, y;                 /* the first value, in row order */
    float value;
    uint64_t not_finite, clamped;
};
struct glint_stability {
    uint32_t seeds, width, height;
    double bound;
    struct glint_stability_image
        *images; /* first those of the capture, then in the order of the passes; finest MIP levels only */
    size_t image_count;
    struct glint_stability_pass *passes; /* those that ran on the device and made images with per_pixel */
    size_t pass_count;
    /* One value a pixel: the `place` of the first pass above the bound and of the first that flips, 0 if there is none, and the
       amplification of the image that the last pass makes. */
    uint32_t *start, *flip_start;
    float *amplification;
    /* The first image of the capture with invalid values, and the first image that is not finite in the order of the passes, of all levels. */
    struct glint_stability_invalid captured, made;
};
/* Loads the capture into the replay with each perturbation in turn, and leaves it loaded unperturbed. Fails if a perturbed frame makes
   the plan run other passes. */
bool glint_stability_measure(struct glint_replay *replay, struct glint_capture *capture,
                             const struct glint_pipeline *pipeline, const struct glint_stability_options *options,
                             glint_progress progress, void *user, struct glint_stability *stability,
                             struct glint_error *err);
void glint_stability_finish(struct glint_stability *stability);

#ifdef __cplusplus
}
#endif
#endif
