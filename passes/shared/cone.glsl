// Cones around rays, and the levels of pre-filtered chains that correspond to them (Mafia III talk, Pre-filtering cube-maps): a level is
// filtered with the cone whose base has a radius of texel_scale texels. Angles are between axis and rim.
#ifndef GLINT_CONE
#define GLINT_CONE
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// tan of an angle in [0, π/2], limited to 1,300 because of the pole at π/2, where the rounded angle may be on either side.
float cone_tangent(float angle) { return tangent(clamp(angle, 0.0, 1.57)); }

// tan of the cone of a level; a face is 2 wide at distance 1. Deviation: the slides print numPixels / cmSize / 2, which contradicts their
// own resolve formula.
float cone_tangent_of_level(float level, float face_size, float texel_scale) {
    return exp2(level) * texel_scale / (0.5 * face_size);
}

// The power n for which cosⁿ falls to `threshold` at the cone's rim: log threshold / log cos. It is computed from the tangent, because
// log cos θ = -log(1 + tan²θ)/2 does not cancel for narrow cones.
float cone_power(float tangent, float threshold) { return -2.0 * log(threshold) / log1p(tangent * tangent); }

// The level of a cube map at the end of a ray. travelled_m: length of the ray, +inf if only its direction counts; from_center_m: distance
// of the end from the cube map's centre. 0 ≤ level ≤ log2 face_size for all distances.
float cone_level_cube(float angle, float travelled_m, float from_center_m, float face_size, float texel_scale) {
    float spread = travelled_m < LARGEST ? min(travelled_m / max(from_center_m, 1e-12), 1e12) : 1.0;
    float texels = cone_tangent(angle) * spread * 0.5 * face_size / texel_scale;
    return log2(clamp(texels, 1.0, face_size));
}

// The level of the screen image at the end of a ray. depth_m: depth of the end; pixels_at_1m: pixels per metre at a depth of 1 m. For a ray
// without end, pass the length and depth of its unit direction, which are 1 and its cosine.
float cone_level_screen(float angle, float travelled_m, float depth_m, float pixels_at_1m, float texel_scale, float last) {
    float spread = min(travelled_m / max(depth_m, 1e-12), 1e12);
    float pixels = cone_tangent(angle) * spread * pixels_at_1m / texel_scale;
    return log2(clamp(pixels, 1.0, exp2(last)));
}
#endif
