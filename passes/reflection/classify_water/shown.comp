#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "shown.pass.h"
#include "shared/push_begin.glsl"
#include "shown.pass.h"
};
#include "shared/constants.glsl"
#include "shared/list_maker.glsl"

uint class_of(ivec2 pixel) {
    if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return 0u;
    float depth_m = texelFetch(water_depth, pixel, 0).x;
    return depth_m > 0.0 && depth_m < INFINITE ? ROUGH : 0u;
}

void main() { make_list(water_tiles, dispatch_phase, 1.0); }
