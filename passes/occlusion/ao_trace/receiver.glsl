// The surface that occlusion is estimated for. Next include of a pass with the rows of slot.h.
#include "shared/camera.glsl"
#include "screen_rays/receiver_normal.glsl"

struct Receiver {
    vec3 position, normal; // in view space
    float depth_m, radius_m;
    vec2 start; // in full-resolution pixels
    uint picked;
};

struct Estimate {
    float visibility, nearest_m;
    uint steps, fetches;
};

precise float occlusion_radius(float depth_m) {
    return radius_in == radius_in_world ? radius_m : radius_part * abs(frame.view_from_uv.y) * depth_m;
}

Receiver receiver_at(ivec2 texel, float depth_m, vec3 shading) {
    Receiver r;
    r.picked = texelFetch(pick, texel, 0).x;
    r.start = picked_position(texel, r.picked, frame.size);
    r.position = view_position(r.start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    r.normal = mat3(frame.view_from_world) * normalize(receiver_normal(r.start, shading));
    r.depth_m = depth_m;
    r.radius_m = occlusion_radius(depth_m);
    return r;
}
