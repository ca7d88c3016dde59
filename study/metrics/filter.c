/* Separable filters on all cores. */
#include "filter.h"

#include <stddef.h>
#include <string.h>

#include "parallel.h"

struct filter {
    const float *from;
    float *to;
    uint32_t width, height;
    const struct kernel *kernel;
};

/* Number of pixels that are filtered at a time, so that their sums stay in registers. */
enum { SPAN = 16 };

static size_t clamp_index(ptrdiff_t at, uint32_t size) {
    return at < 0 ? 0 : at < (ptrdiff_t)size ? (size_t)at : size - 1;
}

static void filter_some_rows(void *user, size_t first, size_t last) {
    const struct filter *f = user;
    const int radius = f->kernel->radius;
    float ends[2 * MAX_RADIUS + SPAN];
    for (size_t y = first; y < last; y++) {
        const float *row = f->from + y * f->width;
        for (uint32_t left = 0; left < f->width; left += SPAN) {
            const bool inside = left >= (uint32_t)radius && left + SPAN + (uint32_t)radius <= f->width;
            const uint32_t n = left + SPAN <= f->width ? SPAN : f->width - left;
            const float *in = row + left - (inside ? radius : 0);
            if (!inside) {
                for (int i = 0; i < 2 * radius + SPAN; i++)
                    ends[i] = row[clamp_index((ptrdiff_t)left + i - radius, f->width)];
                in = ends;
            }
            float sums[SPAN] = {0};
            for (int k = 0; k <= 2 * radius; k++)
                for (int i = 0; i < SPAN; i++) sums[i] += f->kernel->taps[k] * in[k + i];
            memcpy(f->to + y * f->width + left, sums, n * sizeof *sums);
        }
    }
}

static void filter_some_columns(void *user, size_t first, size_t last) {
    const struct filter *f = user;
    const int radius = f->kernel->radius;
    for (size_t y = first; y < last; y++)
        for (uint32_t left = 0; left < f->width; left += SPAN) {
            const uint32_t n = left + SPAN <= f->width ? SPAN : f->width - left;
            float sums[SPAN] = {0};
            for (int k = -radius; k <= radius; k++) {
                const float *in = f->from + clamp_index((ptrdiff_t)y + k, f->height) * f->width + left;
                const float tap = f->kernel->taps[k + radius];
                if (n == SPAN)
                    for (int i = 0; i < SPAN; i++) sums[i] += tap * in[i];
                else
                    for (uint32_t i = 0; i < n; i++) sums[i] += tap * in[i];
            }
            memcpy(f->to + y * f->width + left, sums, n * sizeof *sums);
        }
}

void filter_plane(const float *from, float *scratch, float *to, uint32_t width, uint32_t height,
                  const struct kernel *rows, const struct kernel *columns) {
    parallel_rows(height, filter_some_rows, &(struct filter){from, scratch, width, height, rows});
    parallel_rows(height, filter_some_columns, &(struct filter){scratch, to, width, height, columns});
}
