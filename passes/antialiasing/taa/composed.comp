#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "composed.pass.h"
#include "shared/push_begin.glsl"
#include "composed.pass.h"
};

// The last picture that the pipeline writes.
vec3 picture(ivec2 pixel) {
    if (has_composed_transparent) return texelFetch(composed_transparent, pixel, 0).rgb;
    if (has_composed_fog) return texelFetch(composed_fog, pixel, 0).rgb;
    if (has_composed_water) return texelFetch(composed_water, pixel, 0).rgb;
    return texelFetch(composed, pixel, 0).rgb;
}
#include "accumulate.glsl"
