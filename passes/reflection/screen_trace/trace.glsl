// Traces the ray of a texel. Next include of a variant that defines Result march(ScreenRay ray, ivec2 texel) and has the parameters
// length_m, viewer_limit and sky.
Result trace(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 start = picked_position(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 view = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    precise vec3 direction = mirror_direction(view, mat3(frame.view_from_world) * normal);
    if (length_m <= 0.0) return Result(0.0, false, END_steps_exhausted, 0u, 0u);
    if (viewer_limit < 1.0 && dot(direction, -normalize(view)) > viewer_limit) return Result(0.0, false, END_faced_viewer, 0u, 0u);
    ScreenRay ray = screen_ray(start, view, direction);
    Result result = march(ray, pixel);
    if (sky && ray.vanishes && result.end == ray.limit) {
        result.fetches++;
        vec2 end = clamp(vec2(pixel) + 0.5 + ray.end * ray.across / reduction(frame.size), vec2(0.0), vec2(frame.size.zw) - 0.5);
        if (!(texelFetch(depth_half, ivec2(end), 0).x < LARGEST)) {
            probe_texel_seen(ray, ray.end, ray.end, ivec2(end), 0.0, DECISION_sky);
            return Result(INFINITE, true, END_sky, result.steps, result.fetches);
        }
    }
    return result;
}
#include "main.glsl"
