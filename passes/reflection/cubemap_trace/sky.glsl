// What a ray finds that no cube map can continue. Next include of a pass with the rows of no_cubemap_rows.h.
#include "shared/camera.glsl"

// Without cube maps nothing but the picture tells whether a direction off screen is open: where it shows things above the horizon rather
// than sky, as indoors, these hide the sky in other directions, too.
const int OPEN_GRID = 32;
shared uint points_above, points_open;
bool shows_sky = false;

// Call it before any invocation returns.
void look_for_sky() {
    bool asks = frame.counts.x == 0u && frame.counts.w > 0u && no_cubemap == no_cubemap_seen; // of all invocations alike
    if (!asks) return;
    if (gl_LocalInvocationIndex == 0u) points_above = points_open = 0u;
    barrier();
    uint above = 0u, open = 0u;
    for (uint i = gl_LocalInvocationIndex; i < uint(OPEN_GRID * OPEN_GRID); i += gl_WorkGroupSize.x * gl_WorkGroupSize.y) {
        vec2 uv = (vec2(i % uint(OPEN_GRID), i / uint(OPEN_GRID)) + 0.5) / float(OPEN_GRID);
        vec3 direction = mat3(frame.world_from_view) * view_position(uv, 1.0, frame.view_from_uv, frame.depth_range.z);
        if (!(dot(direction, frame.up.xyz) > 0.0)) continue;
        ++above;
        if (!(texelFetch(depth_full, ivec2(uv * vec2(frame.size.xy)), 0).x < LARGEST)) ++open;
    }
    atomicAdd(points_above, above);
    atomicAdd(points_open, open);
    barrier();
    shows_sky = points_above > 0u && float(points_open) >= open_share * float(points_above);
}

// What a ray finds that no cube map can continue: the sky, the probe or nothing where the capture has no cube maps at all. Painted ground is
// not what lies there.
float travelled_without_cubemaps(float start_m, vec3 direction) {
    bool probe_there = frame.far_light.x > 0.0, ground = dot(direction, frame.up.xyz) < frame.far_light.z;
    bool open = no_cubemap == no_cubemap_sky || (no_cubemap == no_cubemap_seen && (shows_sky || probe_there) && !ground);
    return frame.counts.x == 0u && (frame.counts.w > 0u || probe_there) && open ? INFINITE : start_m;
}
