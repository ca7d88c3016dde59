// Traces a ray from a surface along any direction, as along.glsl does. shift: part of a step by which the samples are shifted.
#include "linear.glsl"

Result trace_along(vec2 start, vec3 position, vec3 direction, ivec2 texel, float shift) {
    if (length_m <= 0.0) return Result(0.0, false, END_steps_exhausted, 0u, 0u);
    if (viewer_limit < 1.0 && dot(direction, -normalize(position)) > viewer_limit) return Result(0.0, false, END_faced_viewer, 0u, 0u);
    ScreenRay ray = screen_ray(start, position, direction);
    float scale = reduction(frame.size);
    vec2 size = vec2(frame.size.zw);
    Grid grid = Grid(vec2(texel), ray.across / scale, start - scale * vec2(texel), scale, size - 1.0, 1.0 / size);
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
