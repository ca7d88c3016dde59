// Where a pixel's surface, or its piece of sky, was in the previous frame. Next include of a pass that reads depth_full and motion_full and has
// the parameter `motion`.
#include "shared/camera.glsl"

bool has_motion() { return motion && textureSize(motion_full, 0) == ivec2(frame.size.xy); }
bool is_sky(float depth_m) { return !(depth_m < LARGEST); }

// In the previous camera's view space. The sky is a direction.
vec3 earlier_view(vec2 uv, float depth_m) {
    vec3 view = view_position(uv, is_sky(depth_m) ? 1.0 : depth_m, frame.view_from_uv, frame.depth_range.z);
    return (frame.previous_view_from_world * vec4(mat3(frame.world_from_view) * view, is_sky(depth_m) ? 0.0 : 1.0)).xyz;
}

// Where it is in the previous picture, with that picture's jitter; outside of [0, 1] where it was not on screen.
vec2 earlier_uv(ivec2 pixel) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    if (has_motion() && !is_sky(depth_m)) return uv + texelFetch(motion_full, pixel, 0).xy;
    vec3 view = earlier_view(uv, depth_m);
    return view.z * frame.depth_range.w > 0.0 ? project(view, frame.previous_uv_from_view, frame.depth_range.w) : vec2(-1.0);
}

// The shift of the picture between both frames by jitter alone, in uv.
vec2 jitter_shift() { return frame.previous_uv_from_view.zw - frame.uv_from_view.zw; }
bool on_screen(vec2 uv) { return all(greaterThanEqual(uv, vec2(0.0))) && all(lessThanEqual(uv, vec2(1.0))); }
