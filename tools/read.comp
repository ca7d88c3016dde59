#version 460
// Stands in for compose/brdf: reads each of the images that it is given of a pixel once, and writes nothing. How long that takes is
// what a frame that calls for no pass is measured by.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "brdf.pass.h"
#include "shared/push_begin.glsl"
#include "brdf.pass.h"
};

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(composed)))) return;
    vec4 sum = texelFetch(lit, pixel, 0) + texelFetch(depth_full, pixel, 0) + texelFetch(normal_full, pixel, 0) +
               texelFetch(albedo_full, pixel, 0) + texelFetch(specular_full, pixel, 0);
    if (sum.x == 1e30) imageStore(composed, pixel, sum); // never, but no compiler knows
}
