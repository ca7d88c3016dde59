/* Packs values into an image's format and counts invalid values: NaN, infinity except in lengths, values beyond the range of half. */
#ifndef GLINT_REPLAY_TEXELS_H
#define GLINT_REPLAY_TEXELS_H

#include <pthread.h>

#include "channels.h"
#include "format.h"

struct bad_values {
    uint64_t not_finite, clamped;
    size_t first; /* index of the first invalid value */
    float value;
};
#define HALF_LARGEST 65504.0f
/* Clamps finite values to the range of half. */
float half_clamped(float value);
/* Counts a value of an image if it is invalid; `index` is its place, `half` the precision in which it will be stored. */
void bad_value(struct bad_values *found, const struct glint_row *row, bool half, size_t index, float value);
/* Adds the counts of other values of the same image. */
void bad_values_add(struct bad_values *found, const struct bad_values *more);
/* The invalid values of texels that the device made. */
struct bad_values bad_halves(const struct glint_row *row, const uint16_t *texels, size_t count);
struct bad_values bad_floats(const struct glint_row *row, const float *texels, size_t count);

/* Converts interleaved 32-bit values to an image's texels. */
struct packing {
    const uint32_t *from; /* float or uint bits */
    size_t stride;        /* values a pixel */
    size_t at[4];         /* index of each component among the values of a pixel; SIZE_MAX: it is `missing` */
    float missing;
    enum glint_format format;
    void *to;
    size_t width;
    const struct glint_row *row; /* if not NULL, invalid values are counted */
    struct bad_values bad;
    pthread_mutex_t lock;
};
/* Sets `at` for the components of a CAPTURE row. */
void pack_place(struct packing *packing, const struct channels *channels, const struct glint_row *row);
void pack_texels(struct packing *packing, uint32_t width, uint32_t height);

#endif
