#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "linear.pass.h"
#include "shared/push_begin.glsl"
#include "linear.pass.h"
};
#include "linear.glsl"
#include "shared/random.glsl"

Result trace(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 start = picked_position(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 view = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    precise vec3 direction = mirror_direction(view, mat3(frame.view_from_world) * normal);
    if (length_m <= 0.0) return Result(0.0, false, END_steps_exhausted, 0u, 0u);
    if (viewer_limit < 1.0 && dot(direction, -normalize(view)) > viewer_limit) return Result(0.0, false, END_faced_viewer, 0u, 0u);
    ScreenRay ray = screen_ray(start, view, direction);
    float scale = reduction(frame.size);
    vec2 size = vec2(frame.size.zw);
    Grid grid = Grid(vec2(pixel), ray.across / scale, start - scale * vec2(pixel), scale, size - 1.0, 1.0 / size);
    float shift = dither ? random4(uvec2(pixel), random_frame(), RANDOM_SCREEN_START).x : 0.0;
    Result result = march(ray, grid, shift);
    if (sky && ray.vanishes && result.end == ray.limit) {
        result.fetches++;
        if (seen_inverse(texel_at(grid, ray.end), grid) == 0.0) {
            probe_texel_seen(ray, ray.end, ray.end, nearest_texel(texel_at(grid, ray.end)), 0.0, DECISION_sky);
            return Result(INFINITE, true, END_sky, result.steps, result.fetches);
        }
    }
    return result;
}
#include "main.glsl"
