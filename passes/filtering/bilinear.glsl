// Interpolates the visibility of the four nearest texels. Next include of a pass that defines float half_visibility(ivec2 texel).
#include "corners.glsl"

float upscaled(ivec2 pixel, float depth_m, vec3 normal) {
    Corners corners = corners_of(pixel);
    float occluded = 0.0, total = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (!(corners.share[i] > 0.0)) continue;
        occluded += corners.share[i] * (1.0 - half_visibility(corner_texel(corners, i)));
        total += corners.share[i];
    }
    return total > 0.0 ? 1.0 - occluded / total : 1.0;
}
