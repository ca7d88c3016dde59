// Constants that several passes share.
#ifndef GLINT_CONSTANTS
#define GLINT_CONSTANTS
const float PI = 3.14159265358979324;
const float HALF_PI = 1.57079632679489662;
const float INFINITE = 1.0 / 0.0;
const float LARGEST = 3.0e38;      // larger values are treated as infinite
const float EVERYTHING_M = 1.0e6;  // with at least this thickness, everything behind a surface is solid

// Whether a colour may be averaged.
bool finite(vec4 color) { return all(lessThan(abs(color), vec4(LARGEST))); }

// Limits a sum of colours to the largest value that images can hold (frame.up.w). NaN stays NaN: values in (largest, +inf] are compared as
// words, because a choice by > may be compiled to min(), which returns the other operand for NaN on some devices.
vec3 storable(vec3 color, float largest) {
    uint most = floatBitsToUint(largest), endless = floatBitsToUint(INFINITE);
    return mix(color, vec3(largest), lessThan(floatBitsToUint(color) - (most + 1u), uvec3(endless - most)));
}
#endif
