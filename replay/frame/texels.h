/* From values to an image's texels, and which of the values no image should hold: NaN, infinity where it is no distance, what
   lies beyond half. */
#ifndef GLINT_REPLAY_TEXELS_H
#define GLINT_REPLAY_TEXELS_H

#include <pthread.h>

#include "channels.h"
#include "format.h"

struct bad_values {
    uint64_t not_finite, clamped;
    size_t first; /* number of the value, and what it is */
    float value;
};
#define HALF_LARGEST 65504.0f
/* Half's largest, with the sign, for what is finite and lies beyond it. */
float half_clamped(float value);
/* One more of an image's values, its number `index`, before it is stored. */
void bad_value(struct bad_values *found, const struct glint_row *row, bool half, size_t index, float value);
/* Of later values too. */
void bad_values_add(struct bad_values *found, const struct bad_values *more);
/* Of texels that the device made. */
struct bad_values bad_halves(const struct glint_row *row, const uint16_t *texels, size_t count);
struct bad_values bad_floats(const struct glint_row *row, const float *texels, size_t count);

/* Conversion of interleaved 32-bit values to an image's texels. */
struct packing {
    const uint32_t *from; /* float or uint bits */
    size_t stride;        /* values a pixel */
    size_t at[4];         /* value of each component; SIZE_MAX: `missing` */
    float missing;
    enum glint_format format;
    void *to;
    size_t width;
    const struct glint_row *row; /* bad values are counted; NULL: not */
    struct bad_values bad;
    pthread_mutex_t lock;
};
/* Where each component of a capture row is among the channels. */
void pack_place(struct packing *packing, const struct channels *channels, const struct glint_row *row);
void pack_texels(struct packing *packing, uint32_t width, uint32_t height);

#endif
