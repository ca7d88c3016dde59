// Dual paraboloids (W. Heidrich, H.-P. Seidel, View-Independent Environment Maps, 1998). A paraboloid mirror about the z axis shows the
// direction d at d.xy / (1 + d.z): the pole at the centre, the equator at radius 1. Directions outside of the disc are in the other hemisphere's
// map at 1 / radius. An area of the plane spans 4 / (1 + r²)² of its size as solid angle, so a texel at the pole spans four times as much as one
// at the rim, unlike what the GTA V article states.
#ifndef GLINT_PARABOLOID
#define GLINT_PARABOLOID
#include "shared/constants.glsl"

// Columns: two axes perpendicular to `up`, and up. The first one is near the world axis along which up has the smallest component.
mat3 paraboloid_axes(vec3 up) {
    vec3 a = abs(up), along = a.x <= a.y && a.x <= a.z ? vec3(1.0, 0.0, 0.0) : a.y <= a.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    vec3 x = normalize(along - dot(along, up) * up);
    return mat3(x, cross(up, x), up);
}

// The lower hemisphere is the mirror image of the upper one, so that a position in both maps has the same azimuth.
vec3 paraboloid_direction(vec2 place, bool upper) {
    float r2 = dot(place, place);
    return vec3(2.0 * place, upper ? 1.0 - r2 : r2 - 1.0) / (1.0 + r2);
}

float paraboloid_solid_angle(vec2 place) {
    float wide = 1.0 + dot(place, place);
    return 4.0 / (wide * wide);
}

// Half the width of a map of `size` texels in radii of its disc: the rim lies on the centres of the outermost texels, so that bilinear lookups
// there have texels on both sides.
float paraboloid_reach(float size) { return size / max(size - 1.0, 1.0); }

// The position on the disc of a texel of a level that is `size` wide, in a map as wide as `widest`.
vec2 paraboloid_place(vec2 texel, float size, float widest) { return (2.0 * texel / size - 1.0) * paraboloid_reach(widest); }

// The uv and the layer, 0 or 1; `d` has unit length and is in the axes above.
vec3 paraboloid_uv(vec3 d, float widest) {
    return vec3(0.5 + 0.5 * d.xy / ((1.0 + abs(d.z)) * paraboloid_reach(widest)), d.z < 0.0 ? 1.0 : 0.0);
}

// The level whose texels are as wide as a cone's radius divided by texel_scale: a texel at r spans 2 / size · 2 / (1 + r²), where
// 2 / (1 + r²) = 1 + |d.z|.
float paraboloid_level(float tangent, float height, float size, float texel_scale) {
    return log2(clamp(tangent * 0.5 * size / (texel_scale * (1.0 + abs(height))), 1.0, size));
}
#endif
