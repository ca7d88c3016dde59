#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "worker.pass.h"
#include "shared/push_begin.glsl"
#include "worker.pass.h"
};

uint texel(uint x, uint y) {
    return dispatch_phase == 2u ? texelFetch(list_b, ivec2(x, y), 0).x : texelFetch(list_a, ivec2(x, y), 0).x;
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    uint count = texel(3u, 0u), i = gl_LocalInvocationIndex + 64u * gl_WorkGroupID.x;
    if (count != 0xFFFFFFFFu) {
        if (i >= count) return;
        uint item = texel(i % 256u, 1u + i / 256u);
        at = uvec2(item & 0xFFFFu, item >> 16u);
    }
    float value = 10.0 + float(dispatch_phase) + 1000.0 * float(at.x + frame.size.z * at.y);
    imageStore(worked, ivec2(at), vec4(value));
}
