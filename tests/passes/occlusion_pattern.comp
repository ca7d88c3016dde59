#version 460
// Stands in for ao_trace/horizon: surfaces within 3 m have one of 16 values by their place in 4 x 4 texels, others are fully occluded.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "horizon.pass.h"
#include "shared/push_begin.glsl"
#include "horizon.pass.h"
};

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(occlusion_half)))) return;
    float value = float((texel.x & 3) + 4 * (texel.y & 3)) / 16.0;
    imageStore(occlusion_half, texel, vec4(texelFetch(depth_half, texel, 0).x < 3.0 ? value : 0.0));
}
