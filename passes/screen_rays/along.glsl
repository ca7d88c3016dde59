// Traces a ray from a surface along any direction. Next include of a pass with the parameters length_m, viewer_limit and sky that defines
// Result march(ScreenRay ray, ivec2 texel). start: the surface's full-resolution pixel, in the texel `texel`; position: in view space.
Result trace_along(vec2 start, vec3 position, vec3 direction, ivec2 texel) {
    if (length_m <= 0.0) return Result(0.0, false, END_steps_exhausted, 0u, 0u);
    if (viewer_limit < 1.0 && dot(direction, -normalize(position)) > viewer_limit) return Result(0.0, false, END_faced_viewer, 0u, 0u);
    ScreenRay ray = screen_ray(start, position, direction);
    Result result = march(ray, texel);
    if (sky && ray.vanishes && result.end == ray.limit) {
        result.fetches++;
        vec2 end = clamp(vec2(texel) + 0.5 + ray.end * ray.across / reduction(frame.size), vec2(0.0), vec2(frame.size.zw) - 0.5);
        if (!(texelFetch(depth_half, ivec2(end), 0).x < LARGEST)) {
            probe_texel_seen(ray, ray.end, ray.end, ivec2(end), 0.0, DECISION_sky);
            return Result(INFINITE, true, END_sky, result.steps, result.fetches);
        }
    }
    return result;
}
