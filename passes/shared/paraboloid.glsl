// Dual paraboloids (W. Heidrich, H.-P. Seidel, View-Independent Environment Maps, 1998). A paraboloid mirror about the z axis
// shows the direction d at the place d.xy / (1 + d.z): the pole in the middle, the equator at radius 1, and what lies beyond
// it outside of the disc, where the other hemisphere has it at 1 / radius. A piece of the plane spans 4 / (1 + r²)² of its
// area as solid angle: a texel at the pole four times that of one at the rim, against what the GTA V article says of its details.
#ifndef GLINT_PARABOLOID
#define GLINT_PARABOLOID
#include "shared/constants.glsl"

// Columns: two axes across `up`, and up. Of the world's axes the smallest part of up lies along the first.
mat3 paraboloid_axes(vec3 up) {
    vec3 a = abs(up), along = a.x <= a.y && a.x <= a.z ? vec3(1.0, 0.0, 0.0) : a.y <= a.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    vec3 x = normalize(along - dot(along, up) * up);
    return mat3(x, cross(up, x), up);
}

// The lower hemisphere is the upper one's mirror image, so that the same place of both is the same way around.
vec3 paraboloid_direction(vec2 place, bool upper) {
    float r2 = dot(place, place);
    return vec3(2.0 * place, upper ? 1.0 - r2 : r2 - 1.0) / (1.0 + r2);
}

float paraboloid_solid_angle(vec2 place) {
    float wide = 1.0 + dot(place, place);
    return 4.0 / (wide * wide);
}

// Half the side of a map `size` wide, in radii of its disc: the rim lies on the middle of its outermost texels, so that a
// bilinear lookup there has texels on either side.
float paraboloid_reach(float size) { return size / max(size - 1.0, 1.0); }

// From texels of a level that is `size` wide, of a map as wide as `widest`.
vec2 paraboloid_place(vec2 texel, float size, float widest) { return (2.0 * texel / size - 1.0) * paraboloid_reach(widest); }

// uv and layer, 0 or 1; `d` is of unit length, in the axes above.
vec3 paraboloid_uv(vec3 d, float widest) {
    return vec3(0.5 + 0.5 * d.xy / ((1.0 + abs(d.z)) * paraboloid_reach(widest)), d.z < 0.0 ? 1.0 : 0.0);
}

// Level whose texels are as wide as a cone's radius divided by texel_scale: a texel at r spans 2 / size · 2 / (1 + r²),
// and 2 / (1 + r²) is 1 + |d.z|.
float paraboloid_level(float tangent, float height, float size, float texel_scale) {
    return log2(clamp(tangent * 0.5 * size / (texel_scale * (1.0 + abs(height))), 1.0, size));
}
#endif
