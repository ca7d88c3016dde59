// Rays towards the sun, and how much their hits shade.
#ifndef GLINT_SUN
#define GLINT_SUN
#include "shared/constants.glsl"
#include "shared/sampling.glsl"

// A mask in [0, 1]; NaN is 0, so that a surface without a valid value counts as in shadow in every pass.
float valid_mask(float captured) { return captured > 0.0 ? min(captured, 1.0) : 0.0; }

// A direction over a disc about a unit vector, uniform in the plane that the disc lies in. angle: of its rim, below a right angle; u: two
// numbers in [0, 1).
precise vec3 disc_direction(vec3 middle, float angle, vec2 u) {
    vec3 tangent, bitangent;
    tangent_frame(middle, tangent, bitangent);
    float radius = tan(angle) * sqrt(u.x), phi = 2.0 * PI * u.y;
    return normalize(middle + radius * (cos(phi) * tangent + sin(phi) * bitangent));
}

// How much a hit counts that is this far from the surface: all of it, but less over the last part of the length; part = 0: none is faded.
float faded_at_end(float travelled_m, float most_m, float part) {
    return part > 0.0 ? clamp((most_m - travelled_m) / (part * most_m), 0.0, 1.0) : 1.0;
}
// The same for a hit near the border of the picture, by its uv; part: of the picture's width and height.
float faded_at_border(vec2 uv, float part) {
    vec2 inside = min(uv, 1.0 - uv);
    return part > 0.0 ? clamp(min(inside.x, inside.y) / part, 0.0, 1.0) : 1.0;
}
#endif
