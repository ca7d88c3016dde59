/* Whether two images are the same within limits, value by value. Limits, counts and verdicts have the meaning of
   OpenImageIO's idiff. */
#ifndef GLINT_DIFFERENCE_H
#define GLINT_DIFFERENCE_H

#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A pixel fails when one of its values differs by more than `fail` and by more than `fail_relative` of the mean of both
   magnitudes. */
struct glint_difference_limit {
    double absolute, relative;
    double percent; /* of pixels that may, before the images do */
    double hard;    /* one difference above this is enough */
};
struct glint_difference_limits {
    struct glint_difference_limit fail, warn;
    uint64_t allow_failures; /* not 0: up to so many pixels may fail by any amount, and all is well */
};
/* idiff's: 1e-6, and nothing is allowed. */
struct glint_difference_limits glint_difference_limits(void);

/* Ordered by how bad they are. */
enum glint_sameness { GLINT_SAME, GLINT_SAME_WARN, GLINT_SAME_FAIL };

/* Of differences: none, up to 1e-8, 1e-7, … 1e4, larger, and of values that are not finite. */
enum { GLINT_DIFFERENCE_BINS = 16 };
/* The upper end of a bin; infinite for the last but one, NaN for the last. */
double glint_difference_bin(size_t bin);

struct glint_difference {
    uint32_t width, height;
    uint64_t pixels, differing, failed, warned;
    uint64_t values;
    double mean, rms,
        psnr;       /* psnr: against 1, or the largest magnitude where that is more; infinite for equal images */
    double largest; /* infinite where only one value is finite */
    uint32_t x, y;  /* where, and in which channel: as they were added */
    size_t channel;
    double a, b;
    uint64_t histogram[GLINT_DIFFERENCE_BINS];
    struct glint_difference_sums *sums; /* until the end */
    uint8_t *marks;                     /* what became of each pixel */
};

bool glint_difference_begin(struct glint_difference *difference, uint32_t width, uint32_t height,
                            struct glint_error *err);
/* Compares `channels` interleaved values a pixel, floats or, for `integers`, uint32_t, and adds them to what was found. Values that
   are both NaN, or infinite alike, are the same. `first`: number of the first of these channels. */
void glint_difference_add(struct glint_difference *difference, const void *a, const void *b, bool integers,
                          uint32_t channels, size_t first, const struct glint_difference_limits *limits);
enum glint_sameness glint_difference_end(struct glint_difference *difference,
                                         const struct glint_difference_limits *limits);
bool glint_difference_fails(const struct glint_difference *difference, size_t pixel);
void glint_difference_finish(struct glint_difference *difference);

#ifdef __cplusplus
}
#endif
#endif
