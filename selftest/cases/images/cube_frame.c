#include "cases/images/cube_frame.h"

#include <stdio.h>

#include "oracles/plain_capture.h"

void cube_frame_fill(struct cube_frame *c, uint32_t size, uint32_t count, cube_frame_texel paint) {
    c->size = size, c->count = count;
    frame_ordinary(&c->frame, 1);
    frame_cameras(&c->frame, cube_frame_eye, cube_frame_eye, 0, 0);
    for (uint32_t k = 0; k < count; k++) {
        snprintf(c->names[k], sizeof c->names[k], "cubemap.%03u", k);
        for (size_t i = 0; i < 6 * (size_t)size * size; i++) {
            double direction[3];
            float texel[5];
            plain_direction((uint32_t)(i / ((size_t)size * size)), (double)(i % size), (double)(i / size % size), size,
                            direction);
            paint(k, i, direction, texel);
            for (int channel = 0; channel < 5; channel++) c->values[k][channel][i] = texel[channel];
        }
        c->parts[k] =
            (struct planes){c->names[k],
                            size,
                            6 * size,
                            {"R", "G", "B", "A", "distance.Z"},
                            {c->values[k][0], c->values[k][1], c->values[k][2], c->values[k][3], c->values[k][4]},
                            GLINT_F32,
                            &c->cube[k]};
    }
    c->frame.more = c->parts;
    c->frame.more_count = count;
}

void random4_expected(uint32_t x, uint32_t y, uint32_t dimension, double u[4]) {
    uint32_t v[4] = {x, y, 5, dimension};
    for (int i = 0; i < 4; i++) v[i] = v[i] * 1664525u + 1013904223u;
    v[0] += v[1] * v[3], v[1] += v[2] * v[0], v[2] += v[0] * v[1], v[3] += v[1] * v[2];
    for (int i = 0; i < 4; i++) v[i] ^= v[i] >> 16;
    v[0] += v[1] * v[3], v[1] += v[2] * v[0], v[2] += v[0] * v[1], v[3] += v[1] * v[2];
    for (int i = 0; i < 4; i++) u[i] = ((double)(v[i] / 512) + 0.5) / 8388608;
}
