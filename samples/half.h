/* Half floats, rounded to nearest even. */
#ifndef SAMPLES_HALF_H
#define SAMPLES_HALF_H

#include <stdint.h>
#include <string.h>

static inline uint16_t half_from(float value) {
    uint32_t bits, sign;
    memcpy(&bits, &value, sizeof bits);
    sign = bits >> 16 & 0x8000;
    bits &= 0x7fffffff;
    if (bits > 0x7f800000) return (uint16_t)(sign | 0x7e00);                                  /* NaN */
    if (bits >= 0x47800000) return (uint16_t)(sign | (bits == 0x7f800000 ? 0x7c00 : 0x7bff)); /* too large: largest */
    if (bits >= 0x38800000) { /* normal: exponent moved, 13 bits rounded away */
        uint32_t rounded = bits + 0xfff + (bits >> 13 & 1) - 0x38000000;
        return (uint16_t)(sign | (rounded >> 13 < 0x7c00 ? rounded >> 13 : 0x7bff));
    }
    float magnitude, magic = 0.5f; /* its last bit is worth the smallest half */
    memcpy(&magnitude, &bits, sizeof magnitude);
    magnitude += magic;
    memcpy(&bits, &magnitude, sizeof bits);
    return (uint16_t)(sign | (bits - 0x3f000000));
}

static inline float half_to(uint16_t half) {
    uint32_t magnitude = half & 0x7fffU, bits;
    float value;
    if (magnitude < 0x400) value = (float)magnitude * (1 / 16777216.0f);
    else {
        bits = magnitude >= 0x7c00 ? 0x7f800000 | magnitude << 13 : (magnitude << 13) + 0x38000000;
        memcpy(&value, &bits, sizeof value);
    }
    return half & 0x8000 ? -value : value;
}

#endif
