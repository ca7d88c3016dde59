#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "edges.pass.h"
#include "shared/push_begin.glsl"
#include "edges.pass.h"
};
#include "shared/camera.glsl"
#include "shared/edges.glsl"
#include "shared/reuse.glsl"
#include "shared/shown.glsl"
#include "shared/work_list.glsl"
#include "source.glsl"

// The small weight of texels of another surface, which are interpolated if none of the four is of the pixel's surface.
const float ELSEWHERE = 1e-4;

// 1 where a texel's sample lies in the pixel's plane.
float in_same_plane(vec3 position, vec3 normal, ivec2 texel, float depth_m) {
    if (depth_part >= 10.0) return 1.0;
    vec2 uv = picked_uv(texel, texelFetch(pick, texel, 0).x, frame.size);
    vec3 way = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z) - position;
    return clamp(2.0 - 2.0 * abs(dot(way, normal)) / max(depth_part * abs(position.z), 1e-20), 0.0, 1.0);
}

vec4 mixture(ivec2 pixel, float depth_m, vec4 surface) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 position = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 normal = mat3(frame.view_from_world) * surface.xyz;
    vec2 place = (vec2(pixel) + 0.5) / reduction(frame.size) - 0.5;
    ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.zw) - 1;
    vec2 part = place - vec2(corner), between = vec2(corner + 1) / vec2(frame.size.zw);
    // Gather's order is (0,1) (1,1) (1,0) (0,0), the loops' (0,0) (1,0) (0,1) (1,1).
    vec4 depths_m = textureGather(sampler2D(depth_half, nearest_clamp), between).wzxy, near, same;
    uint own = 0u; // the texel that represents the pixel's surface
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = corner + ivec2(i & 1, i >> 1);
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        bool used = all(greaterThanEqual(texel, ivec2(0))) && all(lessThanEqual(texel, last)) && depths_m[i] < LARGEST;
        used = used && is_pick_shown(texelFetch(pick, texel, 0).x);
        near[i] = used ? side.x * side.y : 0.0;
        same[i] = near[i] > 0.0 ? in_same_plane(position, normal, texel, depths_m[i]) : 0.0;
        // Edges lie between texels; on which side the pixel is follows from its own normal and roughness.
        if (lobes && same[i] > 0.0) same[i] *= lobe_agreement(surface, texelFetch(normal_half, texel, 0), roughness_part);
        if (near[i] * same[i] > near[own] * same[own]) own = uint(i);
    }
    if (edges && same[own] > 0.0)
        same *= open_in_block(textureGather(usampler2D(edge_levels, nearest_clamp), between).wzxy, own);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        float weight = near[i] * max(same[i], ELSEWHERE);
        if (weight == 0.0) continue;
        sum += taken_color(corner + ivec2(i & 1, i >> 1), weight);
        total += weight;
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec4 surface = texelFetch(normal_full, pixel, 0), color = vec4(0.0);
    probe_pixel(pixel);
    if (tile_works && is_shown(pixel) && reflects(depth_m, surface.xyz)) {
        float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
        color = mixture(pixel, depth_m, vec4(normalize(surface.xyz), roughness));
    }
    imageStore(reflection, pixel, color);
}
