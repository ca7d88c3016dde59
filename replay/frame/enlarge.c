/* Enlarges cube maps: all share one array, so smaller ones are resampled to the size of the largest. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "channels.h"
#include "parallel.h"

/* Texels are taken to be of one surface if their distances along the face's axis differ by no more than this factor. Between others
   there is a silhouette, where interpolation would invent a surface. */
static const double ONE_SURFACE = 1.25;

struct enlarging {
    const float *from;
    float *to;
    uint32_t own, face;        /* face size before and after */
    size_t channels, distance; /* number of channels, and the index of distance.Z or `channels` */
};

/* Linear interpolation along a row or column: two texels and the weight of the second. At a face's border it extrapolates. */
struct lerp {
    uint32_t nearest, low, high;
    double part;
};

static struct lerp lerp_at(const struct enlarging *e, uint32_t i) {
    const double at = (i + 0.5) * e->own / e->face - 0.5;
    struct lerp b = {.nearest = (uint32_t)((2 * (uint64_t)i + 1) * e->own / (2 * (uint64_t)e->face))};
    if (e->own == 1) return b;
    b.low = at > 0 ? (uint32_t)at : 0;
    if (b.low > e->own - 2) b.low = e->own - 2;
    b.high = b.low + 1;
    b.part = at - b.low;
    return b;
}

static double mix_four(const double v[4], double x, double y) {
    return (v[0] * (1 - x) + v[1] * x) * (1 - y) + (v[2] * (1 - x) + v[3] * x) * y;
}

/* Distance from the centre divided by distance along the face's axis, at a texel. */
static double axis_factor(double x, double y, uint32_t size) {
    const double a = (2 * x + 1) / size - 1, b = (2 * y + 1) / size - 1;
    return sqrt(1 + a * a + b * b);
}

/* Interpolates 1 / distance along the axis, which is linear over a plane, also beyond the face's border. Texels of different surfaces or
   sky yield the nearest texel. */
static float distance_at(const struct enlarging *e, const float *const texels[4], float nearest, struct lerp x,
                         struct lerp y, double factor) {
    double inverse[4], least = INFINITY, most = 0;
    for (int k = 0; k < 4; k++) {
        const double distance = (double)texels[k][e->distance];
        if (!(distance > 0)) return nearest;
        inverse[k] = axis_factor(k & 1 ? x.high : x.low, k & 2 ? y.high : y.low, e->own) / distance;
        least = fmin(least, inverse[k]), most = fmax(most, inverse[k]);
    }
    return most <= ONE_SURFACE * least ? (float)(factor / mix_four(inverse, x.part, y.part)) : nearest;
}

static void enlarge_rows(void *user, size_t first, size_t last) {
    const struct enlarging *e = user;
    for (size_t row = first; row < last; row++) {
        const float *face = e->from + row / e->face * e->own * e->own * e->channels;
        const struct lerp y = lerp_at(e, (uint32_t)(row % e->face));
        float *to = e->to + row * e->face * e->channels;
        for (uint32_t column = 0; column < e->face; column++, to += e->channels) {
            const struct lerp x = lerp_at(e, column);
            const float *texels[4];
            for (int k = 0; k < 4; k++)
                texels[k] = face + ((size_t)(k & 2 ? y.high : y.low) * e->own + (k & 1 ? x.high : x.low)) * e->channels;
            for (size_t c = 0; c < e->channels; c++) {
                const double v[4] = {(double)texels[0][c], (double)texels[1][c], (double)texels[2][c],
                                     (double)texels[3][c]};
                if (c != e->distance) to[c] = (float)mix_four(v, fmin(fmax(x.part, 0), 1), fmin(fmax(y.part, 0), 1));
            }
            if (e->distance == e->channels) continue;
            const float nearest = face[((size_t)y.nearest * e->own + x.nearest) * e->channels + e->distance];
            to[e->distance] =
                distance_at(e, texels, nearest, x, y, axis_factor(column, (double)(row % e->face), e->face));
        }
    }
}

bool channels_enlarge(struct channels *channels, uint32_t face, struct glint_error *err) {
    static const char DISTANCE[] = "distance.Z";
    const size_t rows = 6 * (size_t)face, count = channels->count;
    float *to = malloc(rows * face * count * sizeof *to);
    if (!to) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", channels->part->name);
    struct enlarging e = {.from = channels->data,
                          .to = to,
                          .own = channels->part->width,
                          .face = face,
                          .channels = count,
                          .distance = channels_find(channels, DISTANCE, strlen(DISTANCE))};
    parallel_rows(rows, enlarge_rows, &e);
    free(channels->data);
    channels->data = to;
    return true;
}
