#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "tiles.pass.h"
#include "shared/push_begin.glsl"
#include "tiles.pass.h"
};
#include "shared/camera.glsl"
#include "shared/list_maker.glsl"

uint class_of(ivec2 texel) {
    if (any(greaterThanEqual(texel, ivec2(frame.size.zw)))) return 0u;
    vec4 normal = texelFetch(normal_jittered, texel, 0);
    float depth_m = texelFetch(depth_half, texel, 0).x;
    return !reflects(depth_m, normal.xyz) ? 0u : normal.w <= hq_roughness ? SMOOTH : ROUGH;
}

void main() { make_list(screen_list, dispatch_phase, reduction(frame.size)); }
