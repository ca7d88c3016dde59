#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "map.pass.h"
#include "shared/push_begin.glsl"
#include "map.pass.h"
};
#include "shared/bayer.glsl"
#include "shared/camera.glsl"
#include "shared/sun.glsl"

// Where a surface lies in a map: (u, v, depth). False beside it, and where there is no such map.
bool place_in_map(int map, vec3 world, vec3 normal, out vec3 place) {
    mat4 uv_from_world = frame.shadow_uv_from_world[map];
    vec4 at = uv_from_world * vec4(world, 1.0);
    vec3 across = vec3(uv_from_world[0].x, uv_from_world[1].x, uv_from_world[2].x);
    float texel_m = at.w / (length(across) * float(frame.shadow_place[map].z));
    at = uv_from_world * vec4(world + offset * texel_m * normal, 1.0);
    place = at.xyz / at.w;
    return at.w > 0.0 && all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(1.0)));
}

// The part of the compared texels that let the sun pass. wide: texels along a side of the square; shift: of the square, in texels.
float lit_by_map(int map, vec3 place, int wide, vec2 shift) {
    ivec2 size = ivec2(frame.shadow_place[map].zw), row = ivec2(0, frame.shadow_place[map].y);
    ivec2 first = ivec2(floor(place.xy * vec2(size) - 0.5 * float(wide - 1) + shift));
    float away = frame.shadow_depth[map].x, deep = place.z * away, bias = bias_part * frame.shadow_depth[map].y;
    int lit_texels = 0;
    for (int y = 0; y < wide; ++y)
        for (int x = 0; x < wide; ++x) {
            float stored = texelFetch(shadow_map, clamp(first + ivec2(x, y), ivec2(0), size - 1) + row, 0).x;
            if (!(deep > stored * away + bias)) ++lit_texels;
        }
    return float(lit_texels) / float(wide * wide);
}

// By the finest map of all surfaces that holds this one, and by each map of its own class; surfaces in none are lit.
float lit_by_maps(vec3 world, vec3 normal, uint id, vec2 pattern) {
    bool compared = false;
    float lit = 1.0;
    for (int map = 0; map < SHADOW_MAPS && frame.shadow_place[map].z != 0u; ++map) {
        uint of = frame.shadow_place[map].x;
        vec3 place;
        if (of == 0u ? compared : (id & of >> 8u) != (of & 255u)) continue;
        if (!place_in_map(map, world, normal, place)) continue;
        lit = min(lit, lit_by_map(map, place, map == 0 || of != 0u ? taps : far_taps, dither * pattern));
        compared = compared || of == 0u;
    }
    return lit;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shadow_mask)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x, visible = 1.0;
    vec3 normal = texelFetch(normal_full, pixel, 0).xyz;
    if (mask == mask_captured && depth_m > 0.0 && depth_m < LARGEST) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        vec2 pattern = vec2(bayer4(pixel), bayer4(pixel.yx + 2)) - 0.5; // two patterns, so that a block of 4 x 4 pixels is spread over a square
        if (textureSize(sun_mask, 0) == ivec2(frame.size.xy)) visible = valid_mask(texelFetch(sun_mask, pixel, 0).x);
        else if (reflects(depth_m, normal)) visible = lit_by_maps(mat3(frame.world_from_view) * view, normalize(normal), texelFetch(stencil_full, pixel, 0).x, pattern);
    }
    imageStore(shadow_mask, pixel, vec4(visible));
}
