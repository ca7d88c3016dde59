#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "march.pass.h"
#include "shared/push_begin.glsl"
#include "march.pass.h"
};
#include "march.glsl"
#include "sky.glsl"
#define LIST_WORD(place) (has_cubemap_list ? texelFetch(cubemap_list, place).x : texelFetch(tile_list, place).x)
#include "shared/work_list.glsl"

Result trace(ivec2 pixel, float depth_m, vec4 normal, float start_m) {
    uint best = texelFetch(cubemap_best, pixel, 0).x;
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    precise vec3 origin = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 direction = mirror_direction(origin, normal.xyz);
    if (best >= frame.counts.x) return Result(travelled_without_cubemaps(start_m, direction), NO_PLACE, END_no_cubemap, 0u, 0u);
    if (normal.w > max_roughness || !has_distances(best)) return Result(INFINITE, best, END_fallback, 0u, 0u);
    return march(origin, direction, start_m, best, quality_of(normal.w, uvec2(pixel)));
}

void store(ivec2 pixel, Result result) {
    probe_cubemap_end(result.travelled_m, result.place, result.end, result.steps, result.fetches);
    imageStore(travelled, pixel, vec4(result.travelled_m));
    imageStore(cubemap_index, pixel, uvec4(result.place));
    if (!diagnostics) return;
    imageStore(cubemap_end, pixel, uvec4(result.end));
    imageStore(cubemap_steps, pixel, uvec4(result.steps));
    imageStore(cubemap_fetches, pixel, uvec4(result.fetches));
}

bool has_ray(ivec2 pixel, out float depth_m, out vec4 normal) {
    if (texelFetch(screen_finished, pixel, 0).x != 0u) return false;
    depth_m = texelFetch(depth_half, pixel, 0).x;
    normal = texelFetch(normal_jittered, pixel, 0);
    return reflects(depth_m, normal.xyz);
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(travelled)))) return;
    float depth_m, start_m = texelFetch(screen_travelled, pixel, 0).x;
    vec4 normal;
    bool traced = tile_works && has_ray(pixel, depth_m, normal);
    probe_texel(pixel);
    if (traced) store(pixel, trace(pixel, depth_m, normal, start_m));
    else store(pixel, Result(start_m, NO_PLACE, END_not_traced, 0u, 0u));
}
