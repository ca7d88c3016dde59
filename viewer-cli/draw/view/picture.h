/* A picture of 8-bit RGBA, sRGB, rows from the top. */
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

/* Filled with one colour. */
bool picture_init(struct picture *picture, uint32_t width, uint32_t height, struct rgb color, struct glint_error *err);
void picture_finish(struct picture *picture);
void picture_set(struct picture *picture, uint32_t x, uint32_t y, struct rgb color);
/* Mixes a colour in; outside the picture is nothing. */
void picture_blend(struct picture *picture, int x, int y, struct rgb color, uint8_t coverage);
void picture_fill(struct picture *picture, int x, int y, int width, int height, struct rgb color);
/* Copies a whole picture to a place inside another. */
void picture_paste(struct picture *to, const struct picture *from, uint32_t x, uint32_t y);

/* Whether x, y, width, height lie inside. */
bool picture_holds(uint32_t width, uint32_t height, const uint32_t crop[4], struct glint_error *err);
/* These replace the picture. */
bool picture_crop(struct picture *picture, const uint32_t crop[4], struct glint_error *err);
bool picture_zoom(struct picture *picture, uint32_t factor, struct glint_error *err);
/* Each pixel the mean of factor × factor, or its first; what is left over at the right and below is cut. */
bool picture_shrink(struct picture *picture, uint32_t factor, bool mean, struct glint_error *err);
/* Six faces below each other, +X −X +Y −Y +Z −Z as Vulkan orients them, become a horizontal cross with +Z in the middle;
   several cubes become crosses below each other. */
bool picture_cross(struct picture *picture, struct glint_error *err);
/* The same faces as longitude and latitude: +Z in the middle, +X to the right of it, +Y at the top. */
bool picture_latlong(struct picture *picture, struct glint_error *err);
/* Pictures beside each other, the first as it is and the others below each other to its right. */
bool picture_chain(struct picture *chain, const struct picture *pictures, size_t count, struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
