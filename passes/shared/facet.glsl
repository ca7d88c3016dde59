// The surface of a texel as part of a plane. On a plane 1/z is linear on screen, so a facet is the inverse depth at the centre of the texel
// and its slopes: the relative change of 1/z over one texel along x and y.
#ifndef GLINT_FACET
#define GLINT_FACET
#include "shared/camera.glsl"

const float STEEPEST = 1.0; // a facet that reaches infinity within two texels is a silhouette

// The slopes of a plane with this normal (view space). texel: its size in uv. Large if the normal is invalid.
vec2 slopes_of_normal(vec3 normal, vec2 uv, vec2 texel, vec4 view_from_uv, float front) {
    float along = dot(normal, view_position(uv, 1.0, view_from_uv, front));
    return along < 0.0 ? normal.xy * view_from_uv.xy * texel / along : vec2(LARGEST);
}

// The relative decrease of 1/z from one depth to another. A quotient of equal values need not be 1 (Vulkan: 2.5 ULP).
float fall(float depth_m, float other_m) { return depth_m == other_m ? 0.0 : 1.0 - depth_m / other_m; }

// One axis: the less steep of both sides continues the surface, because a step to another surface is steeper. If both are far steeper than the
// normal implies, the surface is no wider than the texel, and only the normal is used.
float facet_slope(float depth_m, float before_m, float after_m, float by_normal) {
    float before = fall(depth_m, before_m), after = -fall(depth_m, after_m);
    float flatter = abs(after) < abs(before) ? after : before;
    float slope = abs(flatter) <= 2.0 * abs(by_normal) + 0.002 ? flatter : by_normal;
    return clamp(slope, -STEEPEST, STEEPEST);
}

// The largest rise of a facet above its centre within the texel, relative to the centre's inverse depth.
float facet_rise(vec2 slopes) { return 0.5 * (abs(slopes.x) + abs(slopes.y)); }
#endif
