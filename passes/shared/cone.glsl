// Cones around rays, and the level of a pre-filtered chain that stands for one (Mafia III talk, Pre-filtering cube-maps). A level
// stands for the cone whose base has a radius of texel_scale of its texels. Angles are between axis and rim.
#ifndef GLINT_CONE
#define GLINT_CONE
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// tan of an angle in [0, π/2], held below 1,300: tan has a pole at π/2, where the rounded angle may lie on its other side.
float cone_tangent(float angle) { return tangent(clamp(angle, 0.0, 1.57)); }

// tan of the cone that a level stands for: a face spans 2 at distance 1. Deviation: the slides print
// numPixels / cmSize / 2, against their own resolve formula.
float cone_tangent_of_level(float level, float face_size, float texel_scale) {
    return exp2(level) * texel_scale / (0.5 * face_size);
}

// The power n with which cosⁿ falls to `threshold` at the cone's rim: log threshold / log cos, by the tangent because
// log cos θ = -log(1 + tan²θ)/2 keeps its digits for narrow cones.
float cone_power(float tangent, float threshold) { return -2.0 * log(threshold) / log1p(tangent * tangent); }

// Level of a cube map at the end of a ray. travelled_m: from the surface to the end, +inf when only the direction
// counts; from_center_m: from the cube map's centre to the end. 0 ≤ level ≤ log2 face_size, whatever the distances.
float cone_level_cube(float angle, float travelled_m, float from_center_m, float face_size, float texel_scale) {
    float spread = travelled_m < LARGEST ? min(travelled_m / max(from_center_m, 1e-12), 1e12) : 1.0;
    float texels = cone_tangent(angle) * spread * 0.5 * face_size / texel_scale;
    return log2(clamp(texels, 1.0, face_size));
}

// Level of the picture at the end of a ray. depth_m: of the end, along the view axis; pixels_at_1m: how many pixels a
// metre spans at a depth of one; for a ray without end pass the length and depth of its unit direction, 1 and its cosine.
float cone_level_screen(float angle, float travelled_m, float depth_m, float pixels_at_1m, float texel_scale, float last) {
    float spread = min(travelled_m / max(depth_m, 1e-12), 1e12);
    float pixels = cone_tangent(angle) * spread * pixels_at_1m / texel_scale;
    return log2(clamp(pixels, 1.0, exp2(last)));
}
#endif
