// The facet of a texel of depth_half, its neighbours fetched. Next include of a pass that reads depth_half and normal_half.
#include "shared/facet.glsl"

// A neighbour of a texel; at the border the opposite neighbour, mirrored at the texel.
vec2 neighbours(ivec2 at, ivec2 axis, float depth_m) {
    ivec2 last = textureSize(depth_half, 0) - 1;
    bool first_texel = any(lessThan(at - axis, ivec2(0))), last_texel = any(greaterThan(at + axis, last));
    float before = first_texel ? depth_m : texelFetch(depth_half, at - axis, 0).x;
    float after = last_texel ? depth_m : texelFetch(depth_half, at + axis, 0).x;
    if (first_texel) before = 1.0 / max(2.0 / depth_m - 1.0 / after, 1.0 / LARGEST);
    if (last_texel) after = 1.0 / max(2.0 / depth_m - 1.0 / before, 1.0 / LARGEST);
    return vec2(before, after);
}

vec2 facet_slopes_at(ivec2 at, float depth_m) {
    if (!(depth_m > 0.0 && depth_m < LARGEST)) return vec2(0.0);
    vec2 size = vec2(textureSize(depth_half, 0));
    vec3 normal = mat3(frame.view_from_world) * texelFetch(normal_half, at, 0).xyz;
    vec2 by_normal = slopes_of_normal(normal, (vec2(at) + 0.5) / size, 1.0 / size, frame.view_from_uv, frame.depth_range.z);
    vec2 x = neighbours(at, ivec2(1, 0), depth_m), y = neighbours(at, ivec2(0, 1), depth_m);
    return vec2(facet_slope(depth_m, x.x, x.y, by_normal.x), facet_slope(depth_m, y.x, y.y, by_normal.y));
}
