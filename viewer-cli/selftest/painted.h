/* Captures with cube maps of any texels, seen by a camera away from the origin, and numbers that shaders draw as random.glsl does. */
#ifndef GLINT_VIEWER_SELFTEST_PAINTED_H
#define GLINT_VIEWER_SELFTEST_PAINTED_H

#include "images.h"

enum { PAINTED_WIDEST = 128, PAINTED_MOST = 4 };
struct painted {
    struct frame frame;
    uint32_t size, count;
    struct glint_cubemap cube[PAINTED_MOST];
    float values[PAINTED_MOST][5][6 * PAINTED_WIDEST * PAINTED_WIDEST];
    char names[PAINTED_MOST][24];
    struct planes parts[PAINTED_MOST + 1];
};

/* Colour, alpha and distance of a texel: its number, its direction. */
typedef void (*painting)(uint32_t cube, size_t texel, const double direction[3], float out[5]);

static const double painted_from[3] = {20, -3, 7}; /* where the camera is */

/* Further parts follow the cube maps' in frame.more. */
void paint_cubes(struct painted *c, uint32_t size, uint32_t count, painting paint);

/* random4(uvec2(x, y), 5u, dimension) */
void drawn4(uint32_t x, uint32_t y, uint32_t dimension, double u[4]);

#endif
