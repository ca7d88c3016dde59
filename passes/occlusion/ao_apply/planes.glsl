// Interpolates those of the four nearest texels that lie in the pixel's plane and face its way. Next include of a pass with the parameters
// depth_part and normal_part that defines float half_visibility(ivec2 texel).
#include "shared/reuse.glsl"
#include "corners.glsl"

// The small weight of texels of another surface, which are interpolated if none of the four is of the pixel's surface.
const float ELSEWHERE = 1e-4;

bool is_same(vec3 position, float depth_m, vec3 normal, ivec2 texel, float texel_m) {
    vec3 apart = texelFetch(normal_half, texel, 0).xyz - normal;
    if (!(0.5 * dot(apart, apart) <= normal_part)) return false;
    vec2 uv = picked_uv(texel, texelFetch(pick, texel, 0).x, frame.size);
    vec3 way = view_position(uv, texel_m, frame.view_from_uv, frame.depth_range.z) - position;
    return depth_part >= 10.0 || in_plane(way, mat3(frame.view_from_world) * normal, depth_m, depth_part);
}

float upscaled(ivec2 pixel, float depth_m, vec3 normal) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 position = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    Corners corners = corners_of(pixel);
    float occluded = 0.0, total = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (!(corners.share[i] > 0.0)) continue;
        ivec2 texel = corner_texel(corners, i);
        float weight = corners.share[i] * (is_same(position, depth_m, normal, texel, corners.depth_m[i]) ? 1.0 : ELSEWHERE);
        occluded += weight * (1.0 - half_visibility(texel));
        total += weight;
    }
    return total > 0.0 ? 1.0 - occluded / total : 1.0;
}
