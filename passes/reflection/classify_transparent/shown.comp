#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "shown.pass.h"
#include "shared/push_begin.glsl"
#include "shown.pass.h"
};
#include "shared/list_maker.glsl"

uint class_of(ivec2 pixel) {
    if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return 0u;
    return texelFetch(transparent_color, pixel, 0).a > 0.0 ? ROUGH : 0u;
}

void main() { make_list(transparent_tiles, dispatch_phase, 1.0); }
