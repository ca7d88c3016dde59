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

Result trace(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 start = picked_position(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 view = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    precise vec3 direction = mirror_direction(view, mat3(frame.view_from_world) * normal);
    float shift = dither ? random4(uvec2(pixel), random_frame(), RANDOM_SCREEN_START).x : 0.0;
    return trace_along(start, view, direction, pixel, shift);
}
#include "main.glsl"
