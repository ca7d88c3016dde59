#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "linear.pass.h"
#include "shared/push_begin.glsl"
#include "linear.pass.h"
};
#include "screen_rays/linear_along.glsl"
#include "shared/random.glsl"

Result trace_from(vec2 start, vec3 position, vec3 direction, ivec2 texel, uint number) {
    float shift = dither ? random4(uvec2(start), number, RANDOM_SCREEN_START).x : 0.0;
    return trace_along(start, position, direction, texel, shift);
}
#include "main.glsl"
