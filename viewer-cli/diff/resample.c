/* Brings an image to a smaller size, so that it can be compared with one of that size. */
#include <math.h>
#include <string.h>

#include "diff/diff.h"

/* The stored texels that one texel covers along an axis: from `first`, with the weights of the first and of the last. */
struct span {
    uint32_t first, last;
    double first_part, last_part;
};

static struct span span_of(uint32_t at, uint32_t from, uint32_t to) {
    const double begin = (double)at * from / to, end = (double)(at + 1) * from / to;
    struct span span = {.first = (uint32_t)begin, .last = (uint32_t)ceil(end) - 1};
    if (span.last >= from) span.last = from - 1;
    span.first_part = fmin(span.first + 1.0, end) - begin;
    span.last_part = span.last > span.first ? end - span.last : span.first_part;
    return span;
}

static double weight_at(const struct span *span, uint32_t i) {
    return i == span->first ? span->first_part : i == span->last ? span->last_part : 1;
}

static float mean_of(const float *in, uint32_t width, const struct span *x, const struct span *y, size_t channels,
                     size_t channel) {
    double sum = 0, weights = 0;
    for (uint32_t v = y->first; v <= y->last; v++)
        for (uint32_t u = x->first; u <= x->last; u++) {
            const double weight = weight_at(x, u) * weight_at(y, v);
            sum += weight * (double)in[((size_t)v * width + u) * channels + channel];
            weights += weight;
        }
    return (float)(sum / weights);
}

void diff_resample(const void *in, struct diff_size from, void *out, struct diff_size to, size_t channels,
                   bool integers) {
    for (uint32_t y = 0; y < to.height; y++) {
        const struct span rows = span_of(y, from.height, to.height);
        const size_t row = (size_t)((y + 0.5) * from.height / to.height);
        for (uint32_t x = 0; x < to.width; x++) {
            const struct span columns = span_of(x, from.width, to.width);
            const size_t column = (size_t)((x + 0.5) * from.width / to.width);
            const size_t at = ((size_t)y * to.width + x) * channels, source = (row * from.width + column) * channels;
            if (integers) memcpy((uint32_t *)out + at, (const uint32_t *)in + source, channels * sizeof(uint32_t));
            for (size_t k = 0; !integers && k < channels; k++)
                ((float *)out)[at + k] = mean_of(in, from.width, &columns, &rows, channels, k);
        }
    }
}
