// The surface of a texel as a piece of a plane. Over a plane 1/z is linear on screen, so a facet is the inverse depth at
// the texel's centre and its slopes: parts of it by which 1/z changes over one texel along x and y.
#ifndef GLINT_FACET
#define GLINT_FACET
#include "shared/camera.glsl"

const float STEEPEST = 1.0; // a facet that would reach infinity within two texels is a silhouette

// The slopes that a plane with this normal (view space) has. texel: its extent in uv. Large when the normal is unusable.
vec2 slopes_of_normal(vec3 normal, vec2 uv, vec2 texel, vec4 view_from_uv, float front) {
    float along = dot(normal, view_position(uv, 1.0, view_from_uv, front));
    return along < 0.0 ? normal.xy * view_from_uv.xy * texel / along : vec2(LARGEST);
}

// How much 1/z falls from a depth to another one, as a part of the first. A quotient of equals need not be 1 (Vulkan: 2.5 ULP).
float fall(float depth_m, float other_m) { return depth_m == other_m ? 0.0 : 1.0 - depth_m / other_m; }

// One axis: the flatter of the two sides continues the surface, because a step to another one is steeper. Where both
// are far steeper than the normal implies, the surface is no wider than the texel, and only the normal is used.
float facet_slope(float depth_m, float before_m, float after_m, float by_normal) {
    float before = fall(depth_m, before_m), after = -fall(depth_m, after_m);
    float flatter = abs(after) < abs(before) ? after : before;
    float slope = abs(flatter) <= 2.0 * abs(by_normal) + 0.002 ? flatter : by_normal;
    return clamp(slope, -STEEPEST, STEEPEST);
}

// How far a facet rises over its centre within the texel, as a part of the centre's inverse depth.
float facet_rise(vec2 slopes) { return 0.5 * (abs(slopes.x) + abs(slopes.y)); }
#endif
