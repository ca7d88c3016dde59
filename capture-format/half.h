/* IEEE half and float, branch-free so that loops over them vectorise on any x86-64. After Fabian Giesen's
   "half_to_float_fast5" and "float_to_half_fast3_rtne" (public domain), written so that neither direction ever works
   on a denormal float: callers may have denormals switched off. */
#ifndef GLINT_HALF_H
#define GLINT_HALF_H

#include <stdint.h>
#include <string.h>

static inline float glint_bits_to_float(uint32_t bits) {
    float f;
    memcpy(&f, &bits, 4);
    return f;
}

static inline uint32_t glint_float_to_bits(float f) {
    uint32_t bits;
    memcpy(&bits, &f, 4);
    return bits;
}

static inline float glint_half_to_float(uint16_t half) {
    const uint32_t magnitude = (uint32_t)(half & 0x7fffu) << 13;
    const uint32_t exponent = magnitude & (0x7c00u << 13);
    const uint32_t infinite = magnitude + ((uint32_t)(255 - 31) << 23);
    const uint32_t normal = magnitude + ((uint32_t)(127 - 15) << 23);
    const float lifted = glint_bits_to_float(magnitude + (113u << 23)) - glint_bits_to_float(113u << 23);
    uint32_t bits = exponent == 0 ? glint_float_to_bits(lifted) : normal;
    bits = exponent == (0x7c00u << 13) ? infinite : bits;
    return glint_bits_to_float(bits | ((uint32_t)(half & 0x8000u) << 16));
}

/* Round to nearest even; too large becomes infinity; a NaN stays one. */
static inline uint16_t glint_float_to_half(float value) {
    const uint32_t all = glint_float_to_bits(value);
    const uint32_t bits = all & 0x7fffffffu;
    const uint32_t magic = ((127u - 15u) + (23u - 10u) + 1u) << 23;
    const uint32_t small = glint_float_to_bits(glint_bits_to_float(bits) + glint_bits_to_float(magic)) - magic;
    const uint32_t normal = (bits + ((uint32_t)(15 - 127) << 23) + 0xfffu + ((bits >> 13) & 1u)) >> 13;
    uint32_t half = bits < (113u << 23) ? small : normal;
    half = bits >= ((127u + 16u) << 23) ? 0x7c00u : half;
    half = bits > (255u << 23) ? 0x7e00u : half;
    return (uint16_t)(half | (all >> 16 & 0x8000u));
}

#endif
