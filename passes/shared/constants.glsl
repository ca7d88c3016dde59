// Constants that several passes share.
#ifndef GLINT_CONSTANTS
#define GLINT_CONSTANTS
const float PI = 3.14159265358979324;
const float HALF_PI = 1.57079632679489662;
const float INFINITE = 1.0 / 0.0;
const float LARGEST = 3.0e38;      // anything above is treated as infinite
const float EVERYTHING_M = 1.0e6;  // a thickness of at least this means that everything is solid

// Whether a colour may be averaged.
bool finite(vec4 color) { return all(lessThan(abs(color), vec4(LARGEST))); }

// A sum of colours as images can hold it (frame.up.w): what is too large becomes the largest. NaN stays NaN: words that mean
// (largest, +inf] are compared as such, because a choice by > may become min(), which some devices answer for NaN with the other.
vec3 storable(vec3 color, float largest) {
    uint most = floatBitsToUint(largest), endless = floatBitsToUint(INFINITE);
    return mix(color, vec3(largest), lessThan(floatBitsToUint(color) - (most + 1u), uvec3(endless - most)));
}
#endif
