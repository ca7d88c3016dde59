/* Shared state of a comparison of two images. */
#ifndef GLINT_STUDY_COMPARISON_H
#define GLINT_STUDY_COMPARISON_H

#include "glint/metrics.h"

/* Quantities that are summed over pixels. Every figure is a function of these sums, so that it can be computed for any set of pixels and any
   resampling of tiles. */
enum quantity {
    SUM_PIXELS,
    SUM_INVALID,
    SUM_TRUTH, /* from here on sums are over all channels */
    SUM_DIFFERENCE,
    SUM_SQUARE,
    SUM_RELATIVE,
    SUM_SYMMETRIC,
    SUM_NOISE,
    SUM_RELATIVE_NOISE,
    SUM_CHEAP,               /* the sums from here on exist only if they are needed */
    SUM_WINDOWS = SUM_CHEAP, /* pixels with an SSIM */
    SUM_SSIM,
    SUM_FLIP,
    SUM_HDR_FLIP,
    SUM_COUNT
};

enum { MAX_CHANNELS = 64, RED = 0, GREEN, BLUE };
enum { LEFT_OUT, COMPARED, INVALID };

struct comparison {
    const struct glint_pixels *found, *truth;
    const struct glint_metric_options *options;
    struct glint_metric_table *table;
    uint32_t channels, found_at[MAX_CHANNELS], truth_at[MAX_CHANNELS]; /* component of each channel */
    bool has_rgb;
    uint32_t rgb[3];             /* the channels that are red, green, blue */
    uint8_t *use;                /* LEFT_OUT, COMPARED or INVALID for each pixel */
    float *ssim;                 /* one value a pixel, NAN without a full window; NULL if not needed */
    uint32_t tile, across, down; /* edge of a tile in pixels, number of tiles */
    double *sums;                /* [tile][row of the table][quantity] */
    int quantities;              /* number of quantities that are summed, SUM_CHEAP or SUM_COUNT */
};

/* The value of a metric by sums over pixels. */
double figure_of(const struct comparison *c, enum glint_metric metric, const double *sums);
static inline const double *sums_of(const struct comparison *c, size_t tile, size_t row) {
    return c->sums + (tile * c->table->count + row) * SUM_COUNT;
}
/* Sets the confidence intervals of the table's figures. */
bool find_intervals(struct comparison *c, struct glint_error *err);

/* Compute maps of SSIM and FLIP if the options ask for them. */
bool map_ssim(struct comparison *c, struct glint_error *err);
bool map_flip(struct comparison *c, struct glint_error *err);

/* Red, green and blue of a pixel of either image, black if it is not compared. */
static inline void read_rgb(const struct comparison *c, bool truth, size_t pixel, float rgb[3]) {
    const struct glint_pixels *image = truth ? c->truth : c->found;
    const uint32_t *at = truth ? c->truth_at : c->found_at;
    for (int k = 0; k < 3; k++)
        rgb[k] = c->use[pixel] == COMPARED ? image->values[pixel * image->components + at[c->rgb[k]]] : 0;
}

static inline bool has_metric(const struct comparison *c, enum glint_metric metric) {
    return c->options->metrics >> metric & 1;
}

#endif
