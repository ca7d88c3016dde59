/* What the parts of a comparison of two images share. */
#ifndef GLINT_STUDY_COMPARISON_H
#define GLINT_STUDY_COMPARISON_H

#include "glint/metrics.h"

/* What is added up over pixels. Every figure is a function of such sums, so that it can be had of any set of pixels and of any
   resampling of tiles. */
enum quantity {
    SUM_PIXELS,
    SUM_INVALID,
    SUM_TRUTH, /* this and the next ones: over all channels */
    SUM_DIFFERENCE,
    SUM_SQUARE,
    SUM_RELATIVE,
    SUM_SYMMETRIC,
    SUM_NOISE,
    SUM_RELATIVE_NOISE,
    SUM_CHEAP,               /* what follows is there only when it was asked for */
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
    uint32_t channels, found_at[MAX_CHANNELS], truth_at[MAX_CHANNELS]; /* components, channel by channel */
    bool has_rgb;
    uint32_t rgb[3];             /* channels that are red, green, blue */
    uint8_t *use;                /* for each pixel */
    float *ssim;                 /* a value a pixel, NAN without a window; NULL when not asked for */
    uint32_t tile, across, down; /* tiles: edge in pixels, how many */
    double *sums;                /* [tile][row of the table][quantity] */
    int quantities;              /* of SUM_COUNT that are there, from the first */
};

/* Value of a metric, of sums over pixels. */
double figure_of(const struct comparison *c, enum glint_metric metric, const double *sums);
static inline const double *sums_of(const struct comparison *c, size_t tile, size_t row) {
    return c->sums + (tile * c->table->count + row) * SUM_COUNT;
}
/* Fills the intervals of the table's figures. */
bool find_intervals(struct comparison *c, struct glint_error *err);

/* Maps of SSIM and FLIP, where the options ask for them. */
bool map_ssim(struct comparison *c, struct glint_error *err);
bool map_flip(struct comparison *c, struct glint_error *err);

/* Red, green and blue of a pixel of either image, black where it is not compared. */
static inline void read_rgb(const struct comparison *c, bool truth, size_t pixel, float rgb[3]) {
    const struct glint_pixels *image = truth ? c->truth : c->found;
    const uint32_t *at = truth ? c->truth_at : c->found_at;
    for (int k = 0; k < 3; k++)
        rgb[k] = c->use[pixel] == COMPARED ? image->values[pixel * image->components + at[c->rgb[k]]] : 0;
}

static inline bool asks_for(const struct comparison *c, enum glint_metric metric) {
    return c->options->metrics >> metric & 1;
}

#endif
