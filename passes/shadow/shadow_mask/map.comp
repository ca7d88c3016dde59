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
#include "clouds.glsl"
#include "shadow_maps/lookup.glsl"

// By the finest map of all surfaces that holds this one, and by each map of its own class; surfaces in none are lit.
float lit_by_maps(vec3 world, vec3 normal, uint id, vec2 pattern) {
    bool compared = false;
    float lit = 1.0;
    for (int map = 0; is_map(map); ++map) {
        uvec4 of = frame.shadow_class[map];
        vec3 place;
        if (is_of_all(map) ? compared : (id & of.y) != of.x) continue;
        vec3 above = world + offset * shadow_texel_m(map, world) * normal; // so that steep surfaces do not shade themselves
        if (!place_in_map(map, above, place)) continue;
        lit = min(lit, lit_by_map(map, place, map == 0 || !is_of_all(map) ? taps : far_taps, dither * pattern, bias_part));
        compared = compared || is_of_all(map);
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
        if (textureSize(sun_mask, 0) == ivec2(frame.size.xy)) visible = through_clouds(pixel) * valid_mask(texelFetch(sun_mask, pixel, 0).x);
        else if (reflects(depth_m, normal)) visible = lit_by_maps(mat3(frame.world_from_view) * view, normalize(normal), texelFetch(stencil_full, pixel, 0).x, pattern);
    }
    imageStore(shadow_mask, pixel, vec4(visible));
}
