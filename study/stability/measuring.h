/* What the parts of a measurement of stability share. */
#ifndef GLINT_STUDY_MEASURING_H
#define GLINT_STUDY_MEASURING_H

#include <string.h>

#include "glint/stability.h"

/* Filters mix what neighbours decided: so far away, in pixels, a decision counts as that of a pixel's own. */
enum { REACH_PX = 8, INPUTS_MAX = 64, DECISIONS_MAX = 32 };

/* One image, from run to run. */
struct tracked {
    struct glint_stability_image *out;
    uint32_t *base;      /* the frame as it is: bits of float or uint */
    double least_scale;  /* of magnitudes that changes are relative to */
    int input, decision; /* which one this is; -1: none */
    uint64_t inputs;     /* that it depends on */
    uint32_t decisions;
    bool reaches; /* its pass reads what neighbours decided: it traces no ray */
};

struct measuring {
    struct glint_replay *replay;
    struct glint_capture *capture;
    const struct glint_stability_options *options;
    struct glint_stability *out;
    struct tracked *tracked; /* beside out->images */
    uint8_t *surfaces;       /* of the frame as it is: compared where not 0 */
    /* A bit for each decision that a seed took otherwise: at the pixel; within reach of it; room to find these. */
    uint32_t *decided[3];
    double input_mean[INPUTS_MAX];
};

/* The pixels of the picture that a texel of an image over it stands for. */
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

/* stability_texels.c: magnitudes of the frame as it is, and forecast of overflow; what a seed decided otherwise; what it
   changed. `values` are the perturbed run's. */
void texels_begin(struct tracked *t);
void texels_decided(const struct measuring *m, struct tracked *t, const uint32_t *values);
void texels_spread(const struct measuring *m);
void texels_changed(const struct measuring *m, struct tracked *t, const uint32_t *values);

/* stability_sum.c: once all seeds have run. */
bool stability_sum_up(struct measuring *m, struct glint_error *err);

#endif
