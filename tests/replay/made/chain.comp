#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "chain.pass.h"
#include "shared/push_begin.glsl"
#include "chain.pass.h"
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(chain);
    int level = int(dispatch_level);
    if (dispatch_phase == 3u) {
        imageStore(beside, at, vec4(10.0 * float(dispatch_level) + float(dispatch_phase)));
        return;
    }
    if (any(greaterThanEqual(at, size))) return;
    float value = 0.0;
    if (dispatch_phase == 0u) value = factor * float(at.x + size.x * at.y) + (texelFetch(depth_full, ivec2(0), 0).x < 0.0 ? 1.0 : 0.0);
    else if (dispatch_phase == 1u) {
        ivec2 last = textureSize(levels, level - 1) - 1;
        for (int i = 0; i < 4; ++i)
            value += texelFetch(levels, min(2 * at + ivec2(i & 1, i >> 1), last), level - 1).x;
        value = mod(value, 4093.0);
    } else {
        ivec2 last = textureSize(levels, level + 1) - 1;
        value = mod(texelFetch(levels, at, level).x + texelFetch(levels, min(at / 2, last), level + 1).x, 4093.0);
    }
    imageStore(chain, at, vec4(value));
}
