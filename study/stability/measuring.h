/* Internal state of a measurement of stability. */
#ifndef GLINT_STUDY_MEASURING_H
#define GLINT_STUDY_MEASURING_H

#include <string.h>

#include "glint/stability.h"

/* Filters mix neighbouring pixels, so decisions of pixels within REACH_PX count as a pixel's own. */
enum { REACH_PX = 8, INPUTS_MAX = 64, DECISIONS_MAX = 32 };

/* An image that is compared between runs. */
struct tracked {
    struct glint_stability_image *out;
    uint32_t *base;      /* texels of the unperturbed frame: bits of float or uint */
    double least_scale;  /* lower bound of the magnitudes that changes are relative to */
    int input, decision; /* its number among the inputs and among the decisions, or -1 */
    uint64_t inputs;     /* masks of the inputs and decisions that it depends on */
    uint32_t decisions;
    bool reaches; /* depends on decisions of neighbouring pixels, as its pass traces no rays */
};

struct measuring {
    struct glint_replay *replay;
    struct glint_capture *capture;
    const struct glint_stability_options *options;
    struct glint_stability *out;
    struct tracked *tracked; /* one for each of out->images */
    uint8_t *labels;         /* of the unperturbed frame; pixels that are not 0 are compared */
    /* Masks of the decisions that flipped in a seed: at each pixel; within REACH_PX of it; scratch memory. */
    uint32_t *decided[3];
    double input_mean[INPUTS_MAX];
};

/* The pixels of the picture that a texel of an image covers. */
struct footprint {
    uint32_t x0, y0, x1, y1;
};
static inline struct footprint footprint_of(const struct glint_stability *s, const struct glint_stability_image *image,
                                            uint32_t x, uint32_t y) {
    const uint32_t across = (s->width + image->width - 1) / image->width,
                   down = (s->height + image->height - 1) / image->height;
    const struct footprint f = {x * across, y * down, (x + 1) * across, (y + 1) * down};
    return (struct footprint){f.x0, f.y0, f.x1 < s->width ? f.x1 : s->width, f.y1 < s->height ? f.y1 : s->height};
}

static inline bool is_end_reason(const struct glint_row *row) {
    return strcmp(row->unit, "end reason") == 0;
}

/* stability_texels.c: finds magnitudes and overflow of the unperturbed frame; finds flipped decisions; spreads them to neighbours; accumulates
   changes. `values` are the texels of a perturbed run. */
void texels_begin(struct tracked *t);
void texels_decided(const struct measuring *m, struct tracked *t, const uint32_t *values);
void texels_spread(const struct measuring *m);
void texels_changed(const struct measuring *m, struct tracked *t, const uint32_t *values);

/* stability_sum.c: computes all results after the last seed. */
bool stability_sum_up(struct measuring *m, struct glint_error *err);

#endif
