#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "linear.pass.h"
#include "shared/push_begin.glsl"
#include "linear.pass.h"
};
#include "screen_rays/linear.glsl"
#include "shared/random.glsl"
#define LIST_WORD(place) texelFetch(transparent_tiles, place).x
#include "shared/work_list.glsl"

Result trace(ivec2 texel, float depth_m, vec3 normal) {
    vec2 start = picked_position(texel, texelFetch(transparent_pick, texel, 0).x, frame.size);
    vec3 view = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    if (length_m <= 0.0) return Result(0.0, false, END_steps_exhausted, 0u, 0u);
    ScreenRay ray = screen_ray(start, view, mirror_direction(view, mat3(frame.view_from_world) * normal));
    // The pixel of a texel may be any of its block, which is its middle on average.
    float scale = reduction(frame.size);
    vec2 size = vec2(frame.size.zw), middle = vec2(0.5 * scale);
    Grid grid = Grid((start - middle) / scale, ray.across / scale, middle, scale, size - 1.0, 1.0 / size);
    Result result = march(ray, grid, dither ? random4(uvec2(texel), random_frame(), RANDOM_SCREEN_START).x : 0.0);
    if (ray.vanishes && result.end == ray.limit) {
        result.fetches++;
        if (seen_inverse(texel_at(grid, ray.end), grid) == 0.0) {
            probe_texel_seen(ray, ray.end, ray.end, nearest_texel(texel_at(grid, ray.end)), 0.0, DECISION_sky);
            return Result(INFINITE, true, END_sky, result.steps, result.fetches);
        }
    }
    return result;
}

void main() {
    ivec2 texel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(texel, imageSize(transparent_screen_travelled)))) return;
    float depth_m = texelFetch(transparent_depth_half, texel, 0).x;
    vec3 normal = texelFetch(transparent_normal_jittered, texel, 0).xyz;
    Result result = Result(0.0, false, END_not_traced, 0u, 0u);
    probe_texel(texel);
    if (tile_works && reflects(depth_m, normal)) result = trace(texel, depth_m, normal);
    probe_screen_end(result);
    imageStore(transparent_screen_travelled, texel, vec4(result.travelled_m));
    imageStore(transparent_screen_finished, texel, uvec4(result.finished ? 1u : 0u));
    if (!diagnostics) return;
    imageStore(transparent_screen_end, texel, uvec4(result.end));
    imageStore(transparent_screen_steps, texel, uvec4(result.steps));
    imageStore(transparent_screen_fetches, texel, uvec4(result.fetches));
}
