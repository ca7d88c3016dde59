// Constants that several passes need; each stands here once.
#ifndef GLINT_CONSTANTS
#define GLINT_CONSTANTS
const float PI = 3.14159265358979324;
const float HALF_PI = 1.57079632679489662;
const float INFINITE = 1.0 / 0.0;
const float LARGEST = 3.0e38;      // anything above is treated as infinite
const float EVERYTHING_M = 1.0e6;  // a thickness of it and more: all is solid

// A colour that may take part in a mean.
bool finite(vec4 color) { return all(lessThan(abs(color), vec4(LARGEST))); }

// A sum of colours as images can hold it (frame.up.w): what is too large becomes the largest. NaN stays NaN.
vec3 storable(vec3 color, float largest) { return mix(color, vec3(largest), greaterThan(color, vec3(largest))); }
#endif
