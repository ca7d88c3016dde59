#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "depth.pass.h"
#include "shared/push_begin.glsl"
#include "depth.pass.h"
};

bool is_other(ivec2 texel, ivec2 pixel) { return false; }
#include "hidden.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(disocclusion)))) return;
    imageStore(disocclusion, pixel, vec4(hidden_at(pixel)));
    imageStore(depth_kept, pixel, texelFetch(depth_full, pixel, 0));
}
