// The position of a pixel in the previous frame. Next include of a pass that reads motion_full and has the rows of reproject_rows.h.
#include "shared/camera.glsl"
#include "shared/sampling.glsl"

struct Reprojection {
    vec2 uv;       // NaN or outside of [0, 1] if it was not on screen; without the jitter of both frames, see below
    vec3 expected; // the position of the surface in the previous camera's view space
    float turned;  // the angle in radians between both view vectors of the surface
};

// position: of the surface, camera-relative world; full_pixel: its texel in motion_full.
Reprojection reproject(vec2 uv, vec3 position, ivec2 full_pixel, float travelled_m) {
    Reprojection r;
    float front = frame.depth_range.w;
    r.expected = (frame.previous_view_from_world * vec4(position, 1.0)).xyz;
    // Both view vectors in the current axes; angles below 1e-6 are rounding errors of the matrices.
    vec3 then = transpose(mat3(frame.previous_view_from_world)) * normalize(r.expected);
    r.turned = max(distance(then, normalize(position)) - 1e-6, 0.0);
    vec4 seen = vec4(position, 1.0);
    if (reprojection == reprojection_reflection) {
        bool endless = !(travelled_m < LARGEST);
        seen = vec4(endless ? position : position + normalize(position) * travelled_m, endless ? 0.0 : 1.0);
        r.turned = 0.0;
    }
    vec3 view = (frame.previous_view_from_world * seen).xyz;
    r.uv = view.z * front > 0.0 ? project(view, frame.previous_uv_from_view, front) : vec2(-1.0);
    if (motion && reprojection == reprojection_surface && textureSize(motion_full, 0) == ivec2(frame.size.xy)) {
        vec2 moved = texelFetch(motion_full, full_pixel, 0).xy;
        // The depth of a moving surface is assumed to be constant, since motion vectors do not contain motion along the view.
        vec4 from_view = frame.previous_uv_from_view;
        r.uv = uv + moved;
        r.expected.xy = (r.uv - from_view.zw) / from_view.xy * r.expected.z * front;
    }
    // Jitter shifts the image. A history stays on the grid of pixels as if there were none: it becomes the mean over the pixel, and a static camera
    // never resamples it. Resampling in each of 16 frames would blur it over 3 pixels.
    r.uv -= frame.previous_uv_from_view.zw - frame.uv_from_view.zw;
    return r;
}

// The longest history of a surface for which the view turns no farther than its lobe allows: a ray turns by as much as the view, and the lobe
// is twice as wide as that of the normals. 0.1 is the slides' threshold for that angle. A mirror has no history as soon as the view turns.
float history_limit(float longest, float roughness, float turned, bool ggx) {
    if (!(turned > 0.0) || divergence == 1e6) return longest;
    float angle = ggx ? ggx_lobe_angle(roughness * roughness, 0.1) : lobe_angle(roughness, 0.1);
    return min(longest, divergence * 2.0 * angle / turned);
}
