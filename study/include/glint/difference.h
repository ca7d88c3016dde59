/* Compares two images value by value and decides whether they are the same within limits, which have the meaning of those of
   OpenImageIO's idiff. */
#ifndef GLINT_DIFFERENCE_H
#define GLINT_DIFFERENCE_H

#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A pixel exceeds the limit if one of its values differs by more than `absolute` and by more than `relative` times the mean of both
   magnitudes. */
struct glint_difference_limit {
    double absolute, relative;
    double percent; /* the images exceed the limit if more than this percentage of the pixels does */
    double hard;    /* the images exceed the limit if a single difference is larger than this */
};
struct glint_difference_limits {
    struct glint_difference_limit fail, warn;
    uint64_t allow_failures; /* if not 0, the images count as the same if no more than this number of pixels fails */
};
/* idiff's defaults: an absolute limit of 1e-6 that no pixel may exceed. */
struct glint_difference_limits glint_difference_limits(void);

/* In ascending order of severity. */
enum glint_sameness { GLINT_SAME, GLINT_SAME_WARN, GLINT_SAME_FAIL };

/* Bins of differences: none, up to 1e-8, up to 1e-7, … up to 1e4, larger, not finite. */
enum { GLINT_DIFFERENCE_BINS = 16 };
/* The upper bound of a bin; infinity for the last but one, NaN for the last. */
double glint_difference_bin(size_t bin);

struct glint_difference {
    uint32_t width, height;
    uint64_t pixels, differing, failed, warned;
    uint64_t values;
    double mean, rms;
    double psnr;    /* with a peak of 1, or of the largest magnitude if that is more; infinite for equal images */
    double largest; /* infinite if only one of the two values is finite */
    uint32_t x, y;  /* where the largest difference is; `channel` is counted over all calls of glint_difference_add */
    size_t channel;
    double a, b;
    uint64_t histogram[GLINT_DIFFERENCE_BINS];
    struct glint_difference_sums *sums; /* internal */
    uint8_t *marks;                     /* internal, one a pixel */
};

bool glint_difference_begin(struct glint_difference *difference, uint32_t width, uint32_t height,
                            struct glint_error *err);
/* Compares `channels` interleaved values a pixel: floats, or uint32_t with `integers`. Two NaNs are the same, as are two infinities of
   one sign. `first` is the number of the first of these channels. */
void glint_difference_add(struct glint_difference *difference, const void *a, const void *b, bool integers,
                          uint32_t channels, size_t first, const struct glint_difference_limits *limits);
/* Computes the figures after the last glint_difference_add. */
enum glint_sameness glint_difference_end(struct glint_difference *difference,
                                         const struct glint_difference_limits *limits);
/* Whether the pixel exceeds the limit `fail`. */
bool glint_difference_fails(const struct glint_difference *difference, size_t pixel);
void glint_difference_finish(struct glint_difference *difference);

#ifdef __cplusplus
}
#endif
#endif
