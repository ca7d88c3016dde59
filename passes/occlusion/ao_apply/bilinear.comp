#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "bilinear.pass.h"
#include "shared/push_begin.glsl"
#include "bilinear.pass.h"
};
#include "shared/camera.glsl"
#include "apply.glsl"
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
