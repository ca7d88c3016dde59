// The surface of a texel at the pipeline's resolution. Next include of a pass that reads depth_half, normal_half and pick.
#ifndef GLINT_SURFACE_AT
#define GLINT_SURFACE_AT
#include "shared/camera.glsl"

struct Surface {
    float depth_m;
    vec3 position; // in view space
    vec4 normal;   // world space; w: roughness
    bool shown;    // visible; invisible reflections are not shared
};

Surface surface_at(ivec2 texel) {
    Surface s;
    s.depth_m = texelFetch(depth_half, texel, 0).x;
    s.normal = texelFetch(normal_half, texel, 0);
    uint picked = texelFetch(pick, texel, 0).x;
    s.shown = is_pick_shown(picked);
    vec2 uv = picked_uv(texel, picked, frame.size);
    s.position = view_position(uv, s.depth_m, frame.view_from_uv, frame.depth_range.z);
    return s;
}
#endif
