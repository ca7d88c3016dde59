/* Image formats and what describes an image, without a device. */
#ifndef GLINT_REPLAY_FORMAT_H
#define GLINT_REPLAY_FORMAT_H

#include <stddef.h>

#include "glint/passes.h"

uint32_t format_components(enum glint_format format);
size_t format_bytes(enum glint_format format); /* of one texel */
const char *format_name(enum glint_format format);
/* The same image with float in place of half. */
enum glint_format format_widened(enum glint_format format);

/* What an image has to be; equal descriptions can reuse an image. */
struct image_desc {
    enum glint_format format;
    uint32_t width, height, layers; /* of one layer; 0: a plain 2D image */
    bool cube;                      /* the layers are six faces for each cube map */
    uint32_t levels;                /* each half as large as the one before it, at least 1 × 1 */
    bool buffer;                    /* of the texels of a plain 2D image, row by row */
};
enum { LEVELS_MAX = 17 };

struct extent {
    uint32_t width, height;
};
bool image_desc_equal(const struct image_desc *a, const struct image_desc *b);
uint32_t image_layers(const struct image_desc *desc); /* at least 1 */
struct extent image_extent(const struct image_desc *desc, uint32_t level);
size_t image_bytes(const struct image_desc *desc, uint32_t level); /* tightly packed */
size_t image_values(const struct image_desc *desc, uint32_t level);
/* How many levels there are down to 1 × 1. */
uint32_t level_count(uint32_t width, uint32_t height);

#endif
