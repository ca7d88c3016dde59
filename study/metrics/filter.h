/* Separable filters over planes of floats; beyond an edge the nearest pixel is repeated. */
#ifndef GLINT_STUDY_FILTER_H
#define GLINT_STUDY_FILTER_H

#include <stdbool.h>
#include <stdint.h>

enum { MAX_RADIUS = 512 };
struct kernel {
    int radius;
    float taps[2 * MAX_RADIUS + 1]; /* taps[0] is at -radius */
};

/* `to` must not be `from`. */
void filter_rows(const float *from, float *to, uint32_t width, uint32_t height, const struct kernel *kernel);
void filter_columns(const float *from, float *to, uint32_t width, uint32_t height, const struct kernel *kernel);

#endif
