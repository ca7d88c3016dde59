#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "march.pass.h"
#include "shared/push_begin.glsl"
#include "march.pass.h"
};
#include "reflection/cubemap_trace/march.glsl"
#include "reflection/cubemap_trace/sky.glsl"
#define LIST_WORD(place) texelFetch(transparent_tiles, place).x
#include "shared/work_list.glsl"

Result trace(ivec2 texel, float depth_m, vec4 normal, float start_m) {
    vec2 uv = picked_uv(texel, texelFetch(transparent_pick, texel, 0).x, frame.size);
    precise vec3 origin = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 direction = mirror_direction(origin, normal.xyz);
    uint best = nearest_active(origin + start_m * direction);
    if (best >= frame.counts.x) return Result(travelled_without_cubemaps(start_m, direction), NO_PLACE, END_no_cubemap, 0u, 0u);
    if (!has_distances(best)) return Result(INFINITE, best, END_fallback, 0u, 0u);
    return march(origin, direction, start_m, best, quality_of(normal.w, uvec2(texel)));
}

void main() {
    load_active_centers();
    ivec2 texel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(texel, imageSize(transparent_travelled)))) return;
    float depth_m = texelFetch(transparent_depth_half, texel, 0).x;
    vec4 normal = texelFetch(transparent_normal_jittered, texel, 0);
    float start_m = texelFetch(transparent_screen_travelled, texel, 0).x;
    Result result = Result(start_m, NO_PLACE, END_not_traced, 0u, 0u);
    probe_texel(texel);
    if (tile_works && texelFetch(transparent_screen_finished, texel, 0).x == 0u && reflects(depth_m, normal.xyz))
        result = trace(texel, depth_m, normal, start_m);
    probe_cubemap_end(result.travelled_m, result.place, result.end, result.steps, result.fetches);
    imageStore(transparent_travelled, texel, vec4(result.travelled_m));
    imageStore(transparent_cubemap_index, texel, uvec4(result.place));
    if (!diagnostics) return;
    imageStore(transparent_cubemap_end, texel, uvec4(result.end));
    imageStore(transparent_cubemap_steps, texel, uvec4(result.steps));
    imageStore(transparent_cubemap_fetches, texel, uvec4(result.fetches));
}
