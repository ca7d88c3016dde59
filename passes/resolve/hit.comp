#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
#include "resolve/color.glsl"
#include "shared/strata.glsl"
#include "shared/tiles.glsl"

// The lookups in the stratum that the ray stands for, those whose places show what it ended on. All end as far away as it did.
vec4 color_of_stratum(Ray ray, vec3 normal, float roughness, vec4 numbers, bool finished, uint place) {
    vec3 tangent, bitangent, to_viewer = -normalize(ray.position);
    tangent_frame(normal, tangent, bitangent);
    Lobe lobe = Lobe(vec3(dot(to_viewer, tangent), dot(to_viewer, bitangent), dot(to_viewer, normal)), roughness, numbers.w == 0.0);
    Stratum around = stratum_of(lobe, numbers.xy, numbers.z);
    vec4 sum = vec4(0.0);
    ray.cone *= 0.5;
    vec4 own = color_without_fog(ray, finished, place, false);
    for (int i = 0; i < STRATUM_TAPS; ++i) {
        vec3 local = around.rays[i];
        if (!(local.z > 0.0)) continue;
        Ray tap = ray;
        tap.direction = local.x * tangent + local.y * bitangent + local.z * normal;
        tap.end = ray.endless ? tap.direction : ray.position + tap.direction * ray.travelled_m;
        tap.cone = tap_cone(around, i, threshold);
        vec4 c = color_without_fog(tap, finished, place, true);
        sum += c.a > 0.0 ? c : own;
    }
    return sum.a > 0.0 ? sum / sum.a : vec4(0.0);
}

vec4 reflected_color(ivec2 pixel, float depth_m, vec4 jittered) {
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cone = has_cone_half ? texelFetch(cone_half, pixel, 0).x : 0.0;
    Ray ray = ended_ray(position, jittered.xyz, texelFetch(travelled, pixel, 0).x, cone);
    bool finished = texelFetch(screen_finished, pixel, 0).x != 0u;
    uint place = texelFetch(cubemap_index, pixel, 0).x;
    vec4 numbers = has_ray_numbers && stratum ? texelFetch(ray_numbers, pixel, 0) : vec4(0.0), color = vec4(0.0);
    if (numbers.z > 0.0)
        color = with_fog(color_of_stratum(ray, texelFetch(normal_half, pixel, 0).xyz, jittered.w, numbers, finished, place), ray);
    return color.a > 0.0 ? color : color_at_end(ray, finished, place);
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(reflection_half)))) return;
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    probe_texel(pixel);
    vec4 color = tile_works && reflects(depth_m, normal.xyz) ? reflected_color(pixel, depth_m, normal) : vec4(0.0);
    imageStore(reflection_half, pixel, color);
}
