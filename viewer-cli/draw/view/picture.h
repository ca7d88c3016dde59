/* A picture of 8-bit RGBA in sRGB, rows from top to bottom. */
#ifndef GLINT_VIEWER_PICTURE_H
#define GLINT_VIEWER_PICTURE_H

#include <stdint.h>

#include "glint/common.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rgb {
    uint8_t r, g, b;
};
static const struct rgb COLOR_BACKGROUND = {0x16, 0x18, 0x1d}, COLOR_TEXT = {0xe6, 0xe8, 0xeb},
                        COLOR_INVALID = {0xff, 0x00, 0xff}, COLOR_INFINITE = {0x00, 0xff, 0xff},
                        COLOR_SKY = {0xb4, 0xc6, 0xdc}, COLOR_NONE = {0x5a, 0x5d, 0x63};

struct picture {
    uint32_t width, height;
    uint8_t *rgba;
};

bool picture_init(struct picture *picture, uint32_t width, uint32_t height, struct rgb color, struct glint_error *err);
void picture_finish(struct picture *picture);
void picture_set(struct picture *picture, uint32_t x, uint32_t y, struct rgb color);
/* Blends a colour over a pixel; pixels outside of the picture are ignored. */
void picture_blend(struct picture *picture, int x, int y, struct rgb color, uint8_t coverage);
void picture_fill(struct picture *picture, int x, int y, int width, int height, struct rgb color);
/* Copies a picture to a position inside of another. */
void picture_paste(struct picture *to, const struct picture *from, uint32_t x, uint32_t y);

/* Whether the rectangle x, y, width, height lies inside. */
bool picture_holds(uint32_t width, uint32_t height, const uint32_t crop[4], struct glint_error *err);
/* The following functions replace the picture. */
bool picture_crop(struct picture *picture, const uint32_t crop[4], struct glint_error *err);
bool picture_zoom(struct picture *picture, uint32_t factor, struct glint_error *err);
/* Reduces blocks of factor × factor pixels to their mean, or to their first pixel. Incomplete blocks at the right and
   bottom are cut off. */
bool picture_shrink(struct picture *picture, uint32_t factor, bool mean, struct glint_error *err);
/* Arranges columns of six faces (+X −X +Y −Y +Z −Z in Vulkan's orientation) as horizontal crosses with +Z in the
   middle, one below the other. */
bool picture_cross(struct picture *picture, struct glint_error *err);
/* Converts the same faces to longitude and latitude: +Z in the middle, +X to its right, +Y at the top. */
bool picture_latlong(struct picture *picture, struct glint_error *err);
/* Places the first picture on the left, and the others below each other on its right. */
bool picture_chain(struct picture *chain, const struct picture *pictures, size_t count, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
