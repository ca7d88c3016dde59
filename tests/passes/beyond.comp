#version 460
// Stands in for upscale/bilinear: each column stores another value into an image of half floats.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "bilinear.pass.h"
#include "shared/push_begin.glsl"
#include "bilinear.pass.h"
};

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;
    float zero = float(dispatch_level), endless = 1.0 / zero;
    float values[8] = float[](1e6, -3e38, 65504.0, 1024.0, 5.9604644775390625e-8, endless, -endless, zero * endless);
    imageStore(reflection, pixel, vec4(values[pixel.x & 7], 1.0, -0.25, 70000.0));
}
