#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "picked.pass.h"
#include "shared/push_begin.glsl"
#include "picked.pass.h"
};
#include "shared/camera.glsl"

// Invalid depths come last.
bool comes_first(float depth_m, float before_m) {
    if (!(depth_m > 0.0 && depth_m < LARGEST)) return false;
    return !(before_m > 0.0 && before_m < LARGEST) || (choose == choose_nearest ? depth_m < before_m : depth_m > before_m);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(linear_depth_half)))) return;
    int wide = int(reduction(frame.size));
    vec2 found = vec2(texelFetch(depth_full, wide * texel, 0).x, 0.0);
    for (int i = 1; i < wide * wide && choose != choose_first; ++i) {
        ivec2 pixel = wide * texel + ivec2(i & 1, i >> 1);
        if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) continue;
        float depth_m = texelFetch(depth_full, pixel, 0).x;
        if (comes_first(depth_m, found.x)) found = vec2(depth_m, float(i));
    }
    imageStore(linear_depth_half, texel, vec4(found, 0.0, 0.0));
}
