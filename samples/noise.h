/* Deterministic, stateless variation: integer hashes, value noise, low-discrepancy points. */
#ifndef SAMPLES_NOISE_H
#define SAMPLES_NOISE_H

#include "vec.h"

/* Wellons' lowbias32. */
static inline uint32_t hash_u32(uint32_t x) {
    x = (x ^ x >> 16) * 0x7feb352dU;
    x = (x ^ x >> 15) * 0x846ca68bU;
    return x ^ x >> 16;
}
static inline uint32_t hash_two(uint32_t a, uint32_t b) {
    return hash_u32(a ^ hash_u32(b + 0x9e3779b9U));
}
/* In [0, 1). */
static inline float unit_float(uint32_t hash) {
    return (float)(hash >> 8) * (1 / 16777216.0f);
}
static inline float cell_random(int32_t x, int32_t y, uint32_t seed) {
    return unit_float(hash_two(hash_two((uint32_t)x, (uint32_t)y), seed));
}

/* Value noise in [0, 1] with a cell size of 1. */
static inline float noise2(float x, float y, uint32_t seed) {
    float fx = floorf(x), fy = floorf(y);
    int32_t ix = (int32_t)fx, iy = (int32_t)fy;
    float u = smooth(0, 1, x - fx), v = smooth(0, 1, y - fy);
    float low = cell_random(ix, iy, seed) * (1 - u) + cell_random(ix + 1, iy, seed) * u;
    float high = cell_random(ix, iy + 1, seed) * (1 - u) + cell_random(ix + 1, iy + 1, seed) * u;
    return low * (1 - v) + high * v;
}
static inline float fractal2(float x, float y, int octaves, uint32_t seed) {
    float sum = 0, weight = 0.5f, total = 0;
    for (int i = 0; i < octaves; i++, weight *= 0.5f, x = x * 2.03f + 17, y = y * 2.03f - 9) {
        sum += weight * noise2(x, y, seed + (uint32_t)i);
        total += weight;
    }
    return sum / total;
}

/* Van der Corput sequence. */
static inline double radical_inverse(uint32_t i, uint32_t base) {
    double result = 0, digit = 1.0 / base;
    for (; i; i /= base, digit /= base) result += digit * (i % base);
    return result;
}
/* Point i of Roberts' R2 sequence in [0, 1)², shifted by a hash. */
static inline void r2_point(uint32_t i, uint32_t seed, float *u, float *v) {
    uint32_t a = hash_two(seed, 1) + i * 3242174889U, b = hash_two(seed, 2) + i * 2447445414U;
    *u = unit_float(a);
    *v = unit_float(b);
}

#endif
