// Points of the depth buffer, and random numbers. Next include of a pass with the rows of points_rows.h, after receiver.glsl.
#include "shared/blue_noise.glsl"

// The position of a texel's surface, in view space; false where there is none.
bool point_at(ivec2 texel, Receiver r, inout Estimate result, out vec3 position) {
    float depth_m = texelFetch(depth_half, texel, 0).x;
    uint picked = r.picked;
    if (picks) picked = texelFetch(pick, texel, 0).x;
    result.steps++;
    result.fetches += picks ? 2u : 1u;
    position = view_position(picked_uv(texel, picked, frame.size), depth_m, frame.view_from_uv, frame.depth_range.z);
    return depth_m > 0.0 && depth_m < LARGEST;
}

ivec2 texel_of(vec2 pixel) { return ivec2(floor(pixel / reduction(frame.size))); }
bool inside(ivec2 texel) { return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(frame.size.zw))); }

// Whether a point lies above the tangent plane and not in it. up: its height over the plane.
precise bool is_raised(Receiver r, vec3 way, float up) {
    return up > lift * r.radius_m && up * up > bias * bias * dot(way, way);
}

// Three numbers in [0, 1). The grid is that of Jimenez et al. 2016, slides 74 to 77 (spatial) and the golden ratio from frame to frame.
vec3 numbers_at(ivec2 texel) {
    uint number = (shuffle ? frame.counts.y : 0u);
    if (pattern == pattern_white) return random4(uvec2(texel), number + frame.flags.w * 0x9E3779B9u, RANDOM_OCCLUSION).xyz;
    if (pattern == pattern_blue)
        return vec3(blue_noise2(uvec2(texel), number, frame.flags.w), random4(uvec2(texel), number, RANDOM_OCCLUSION).z);
    vec3 base = vec3(0.5);
    if (pattern == pattern_grid) {
        int direction = ((texel.x + texel.y & 3) << 2) + (texel.x & 3);
        base = (vec3(direction, 4 * (texel.y - texel.x & 3), direction * 5 & 15) + 0.5) / 16.0;
    }
    float turns = float((number + frame.flags.w) & 0xFFFFu);
    return fract(base + fract(turns * vec3(0.6180339887, 0.7548776662, 0.5698402910)));
}
