// Interpolates the visibility of those of the four nearest texels that lie in the pixel's plane and face its way. Next include of a pass with the parameters
// depth_part and normal_part that defines float half_visibility(ivec2 texel).
#include "same_surface.glsl"
#include "corners.glsl"

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
