/* Captures with cube maps of arbitrary texels and a camera away from the origin, and the random numbers of random.glsl. */
#ifndef GLINT_SELFTEST_CUBE_FRAME_H
#define GLINT_SELFTEST_CUBE_FRAME_H

#include "harness/image_case.h"

enum { CUBE_FRAME_WIDEST = 128, CUBE_FRAME_MOST = 4 };
struct cube_frame {
    struct frame frame;
    uint32_t size, count;
    struct glint_cubemap cube[CUBE_FRAME_MOST];
    float values[CUBE_FRAME_MOST][5][6 * CUBE_FRAME_WIDEST * CUBE_FRAME_WIDEST];
    char names[CUBE_FRAME_MOST][24];
    struct planes parts[CUBE_FRAME_MOST + 1];
};

/* Sets colour, alpha and distance of a texel by its number and direction. */
typedef void (*cube_frame_texel)(uint32_t cube, size_t texel, const double direction[3], float out[5]);

static const double cube_frame_eye[3] = {20, -3, 7}; /* where the camera is */

/* Further parts follow those of the cube maps in frame.more. */
void cube_frame_fill(struct cube_frame *c, uint32_t size, uint32_t count, cube_frame_texel paint);

/* random4(uvec2(x, y), 5u, dimension) */
void random4_expected(uint32_t x, uint32_t y, uint32_t dimension, double u[4]);

#endif
