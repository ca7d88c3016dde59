#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "planes.pass.h"
#include "shared/push_begin.glsl"
#include "planes.pass.h"
};
#include "shared/camera.glsl"
#include "filtering/corners.glsl"
#include "filtering/same_surface.glsl"

float weight_of(ivec2 pixel, float depth_m, vec3 normal, ivec2 texel, float texel_m) {
    vec3 position = view_position((vec2(pixel) + 0.5) / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    return is_same(position, depth_m, normal, texel, texel_m) ? 1.0 : ELSEWHERE;
}
#include "apply.glsl"
