/* Compares two images value by value. */
#include "glint/difference.h"

#include <math.h>
#include <stdlib.h>

#include "parallel.h"

enum { DIFFERS = 1, WARNED = 2, FAILED = 4, FIRST_DECADE = -8 };

/* Sums of one row of pixels. Rows are added up in order, so that results do not depend on threads. */
struct glint_difference_sums {
    double sum, square, top, largest, a, b;
    uint32_t x;
    size_t channel;
    uint64_t histogram[GLINT_DIFFERENCE_BINS];
};

struct glint_difference_limits glint_difference_limits(void) {
    const struct glint_difference_limit limit = {.absolute = 1e-6, .hard = (double)INFINITY};
    return (struct glint_difference_limits){.fail = limit, .warn = limit};
}

double glint_difference_bin(size_t bin) {
    if (bin >= GLINT_DIFFERENCE_BINS - 1) return (double)NAN;
    if (bin == GLINT_DIFFERENCE_BINS - 2) return (double)INFINITY;
    return bin ? pow(10, FIRST_DECADE + (int)bin - 1) : 0;
}

static size_t bin_of(double by) {
    static const double ends[] = {0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1, 1e1, 1e2, 1e3, 1e4};
    size_t bin = 0;
    if (!isfinite(by)) return GLINT_DIFFERENCE_BINS - 1;
    while (bin < sizeof ends / sizeof *ends && by > ends[bin]) bin++;
    return bin;
}

bool glint_difference_begin(struct glint_difference *d, uint32_t width, uint32_t height, struct glint_error *err) {
    *d = (struct glint_difference){.width = width, .height = height, .pixels = (uint64_t)width * height};
    d->sums = calloc(height, sizeof *d->sums);
    d->marks = calloc(d->pixels, 1);
    return (d->sums && d->marks) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

struct adding {
    struct glint_difference *to;
    const void *a, *b;
    bool integers;
    uint32_t channels;
    size_t first;
    const struct glint_difference_limits *limits;
};

static double value_at(const struct adding *adding, const void *values, size_t i) {
    return adding->integers ? ((const uint32_t *)values)[i] : (double)((const float *)values)[i];
}

static bool is_over(const struct glint_difference_limit *limit, double by, double size) {
    return by > limit->absolute && by > limit->relative * size;
}

static uint8_t add_value(struct glint_difference_sums *sums, const struct glint_difference_limits *limits, double a,
                         double b, uint32_t x, size_t channel) {
    const bool same = a == b || (isnan(a) && isnan(b));
    const double exact = fabs(a - b), by = same ? 0 : isfinite(exact) ? exact : (double)INFINITY;
    const double size = 0.5 * (fabs(a) + fabs(b));
    sums->histogram[bin_of(by)]++;
    sums->sum += by;
    sums->square += by * by;
    if (isfinite(size)) sums->top = fmax(sums->top, fmax(fabs(a), fabs(b)));
    if (by > sums->largest) sums->largest = by, sums->a = a, sums->b = b, sums->x = x, sums->channel = channel;
    if (same) return 0;
    if (isinf(by)) return DIFFERS | WARNED | FAILED;
    return (uint8_t)(DIFFERS | (is_over(&limits->warn, by, size) ? WARNED : 0) |
                     (is_over(&limits->fail, by, size) ? FAILED : 0));
}

static void add_rows(void *user, size_t first, size_t last) {
    const struct adding *adding = user;
    const struct glint_difference *d = adding->to;
    for (size_t y = first; y < last; y++)
        for (uint32_t x = 0; x < d->width; x++) {
            const size_t pixel = y * d->width + x;
            for (uint32_t k = 0; k < adding->channels; k++) {
                const size_t i = pixel * adding->channels + k;
                d->marks[pixel] |= add_value(&d->sums[y], adding->limits, value_at(adding, adding->a, i),
                                             value_at(adding, adding->b, i), x, adding->first + k);
            }
        }
}

void glint_difference_add(struct glint_difference *d, const void *a, const void *b, bool integers, uint32_t channels,
                          size_t first, const struct glint_difference_limits *limits) {
    struct adding adding = {d, a, b, integers, channels, first, limits};
    d->values += d->pixels * channels;
    parallel_rows(d->height, add_rows, &adding);
}

static bool is_too_much(const struct glint_difference *d, const struct glint_difference_limit *limit, uint64_t over) {
    return (double)over > limit->percent / 100 * (double)d->pixels || d->largest > limit->hard;
}

enum glint_sameness glint_difference_end(struct glint_difference *d, const struct glint_difference_limits *limits) {
    double top = 1, square = 0;
    for (uint32_t y = 0; y < d->height; y++) {
        const struct glint_difference_sums *row = &d->sums[y];
        d->mean += row->sum;
        square += row->square;
        top = fmax(top, row->top);
        for (size_t k = 0; k < GLINT_DIFFERENCE_BINS; k++) d->histogram[k] += row->histogram[k];
        if (row->largest <= d->largest) continue;
        d->largest = row->largest;
        d->x = row->x;
        d->y = y;
        d->channel = row->channel;
        d->a = row->a;
        d->b = row->b;
    }
    if (d->values) d->mean /= (double)d->values, d->rms = sqrt(square / (double)d->values);
    d->psnr = d->rms > 0 ? 20 * log10(top / d->rms) : (double)INFINITY;
    for (size_t i = 0; i < d->pixels; i++) {
        d->differing += (d->marks[i] & DIFFERS) != 0;
        d->warned += (d->marks[i] & WARNED) != 0;
        d->failed += (d->marks[i] & FAILED) != 0;
    }
    if (limits->allow_failures && d->failed <= limits->allow_failures) return GLINT_SAME;
    if (is_too_much(d, &limits->fail, d->failed)) return GLINT_SAME_FAIL;
    return is_too_much(d, &limits->warn, d->warned) ? GLINT_SAME_WARN : GLINT_SAME;
}

bool glint_difference_fails(const struct glint_difference *d, size_t pixel) {
    return d->marks[pixel] & FAILED;
}

void glint_difference_finish(struct glint_difference *d) {
    free(d->sums);
    free(d->marks);
    *d = (struct glint_difference){0};
}
