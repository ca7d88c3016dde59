#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "memory.pass.h"
#include "shared/push_begin.glsl"
#include "memory.pass.h"
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    bool valid = frame.flags.x == 1u;
    ivec2 here = valid ? at : ivec2(0); // without history, stand-ins of one pixel
    vec4 value = vec4(texelFetch(sum_before, here, 0).x + 1.0, valid ? 1.0 : 0.0, texelFetch(depth_before, here, 0).x, 0.0);
    if (valid) value.w = texelFetch(chain_before, min(at / 4, textureSize(chain_before, 2) - 1), 2).x;
    imageStore(sum, at, value);
    imageStore(depth_now, at, vec4(texelFetch(depth_full, at, 0).x + (texelFetch(chain, at, 0).x < 0.0 ? 1.0 : 0.0)));
}
