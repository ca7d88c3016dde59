// Random numbers from a hash: stateless, with identical bits on every device.
#ifndef GLINT_RANDOM
#define GLINT_RANDOM

// The use of a number; numbers of different dimensions are independent.
const uint RANDOM_SCREEN_START = 1u;
const uint RANDOM_STEP_SCALE = 2u;
const uint RANDOM_OCCLUSION = 3u;
const uint RANDOM_CONTACT = 4u;
const uint RANDOM_INDIRECT = 5u;
const uint RANDOM_GRAIN = 6u;
const uint RANDOM_NDF = 16u; // and the following ones, one for each attempt

// Hashes four words. M. Jarzynski, M. Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020: pcg4d.
uvec4 hash4(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    for (int round = 0; round < 2; ++round) {
        v.x += v.y * v.w;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v.w += v.y * v.z;
        if (round == 0) v ^= v >> 16u;
    }
    return v;
}

// Uniform in the open interval (0, 1). 23 bits and a half are exact in a float.
vec4 random4(uvec2 pixel, uint frame_number, uint dimension) {
    return (vec4(hash4(uvec4(pixel, frame_number, dimension)) >> 9u) + 0.5) * 1.1920928955078125e-7;
}
#endif
