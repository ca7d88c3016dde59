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
#include "shared/fog.glsl"
#include "shadow_maps/lookup.glsl"

// The light that the fog scatters along the first metres of a ray, as a part of what endless fog would: all between two places is the difference.
float scattered(float slope, float along_m) {
    return fog_factor(fog_optical_depth(frame.fog_color.w, frame.fog_height.x, slope, frame.fog_height.y, along_m));
}

// By the finest map that holds the point; points in none are lit.
float lit_in_air(vec3 world) {
    vec3 place;
    for (int map = 0; is_map(map); ++map)
        if (is_of_all(map) && place_in_map(map, world, place)) return lit_by_map(map, place, 1, vec2(0.0), bias_part);
    return 1.0;
}

float lit_part(ivec2 texel, vec3 ray, float length_of_ray, float depth_m) {
    vec3 direction = mat3(frame.world_from_view) * ray / length_of_ray;
    float far_m = depth_m < LARGEST ? depth_m * length_of_ray : INFINITE, slope = dot(direction, frame.up.xyz);
    float all = scattered(slope, far_m), march_m = min(far_m, length_m);
    if (!(all > 0.0)) return 1.0;
    float place = pattern == pattern_bayer ? bayer4(texel) + 1.0 / 32.0 : 0.5, before = 0.0, shaded = 0.0;
    for (int i = 0; i < steps; ++i) {
        float after = scattered(slope, march_m * float(i + 1) / float(steps));
        float at_m = march_m * (float(i) + place) / float(steps);
        shaded += (after - before) * (1.0 - lit_in_air(at_m * direction));
        before = after;
    }
    return clamp(1.0 - shaded / all, 0.0, 1.0);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(shaft_half)))) return;
    float depth_m = texelFetch(depth_half, texel, 0).x, lit = 1.0;
    if (depth_m > 0.0) {
        vec2 uv = picked_uv(texel, texelFetch(pick, texel, 0).x, frame.size);
        vec3 ray = view_position(uv, 1.0, frame.view_from_uv, frame.depth_range.z);
        lit = lit_part(texel, ray, length(ray), depth_m);
    }
    imageStore(shaft_half, texel, vec4(lit));
}
