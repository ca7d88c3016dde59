/* Separable filters over planes of floats; past an edge the nearest pixel repeats. */
#ifndef GLINT_STUDY_FILTER_H
#define GLINT_STUDY_FILTER_H

#include <stdbool.h>
#include <stdint.h>

enum { MAX_RADIUS = 512 };
struct kernel {
    int radius;
    float taps[2 * MAX_RADIUS + 1]; /* from -radius on */
};

/* `to` must be another plane. */
void filter_rows(const float *from, float *to, uint32_t width, uint32_t height, const struct kernel *kernel);
void filter_columns(const float *from, float *to, uint32_t width, uint32_t height, const struct kernel *kernel);

#endif
