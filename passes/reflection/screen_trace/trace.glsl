// Traces the mirror ray of a texel. Next include of a variant that defines Result march(ScreenRay ray, ivec2 texel) and has the parameters
// length_m, viewer_limit and sky.
#include "screen_rays/along.glsl"

Result trace(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 start = picked_position(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 view = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    precise vec3 direction = mirror_direction(view, mat3(frame.view_from_world) * normal);
    return trace_along(start, view, direction, pixel);
}
#include "main.glsl"
