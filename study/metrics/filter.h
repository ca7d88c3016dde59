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

/* Filters the rows with one kernel and the columns with another. The three planes must be different. */
void filter_plane(const float *from, float *scratch, float *to, uint32_t width, uint32_t height,
                  const struct kernel *rows, const struct kernel *columns);

#endif
