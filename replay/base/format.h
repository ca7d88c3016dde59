/* Image formats and descriptions, independent of a device. */
#ifndef GLINT_REPLAY_FORMAT_H
#define GLINT_REPLAY_FORMAT_H

#include <stddef.h>

#include "glint/passes.h"

uint32_t format_components(enum glint_format format);
size_t format_bytes(enum glint_format format); /* of one texel */
const char *format_name(enum glint_format format);
/* The format with float instead of half. */
enum glint_format format_widened(enum glint_format format);

/* The description of an image. An image can be reused wherever the description is equal. */
struct image_desc {
    enum glint_format format;
    uint32_t width, height, layers; /* layers: 0 for a plain 2D image */
    bool cube;                      /* the layers are faces of cube maps */
    uint32_t levels;                /* MIP levels */
    bool buffer;                    /* a texel buffer that holds a plain 2D image row by row */
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
/* The number of MIP levels down to 1 × 1. */
uint32_t level_count(uint32_t width, uint32_t height);

#endif
