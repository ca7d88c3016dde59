#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "classes.pass.h"
#include "shared/push_begin.glsl"
#include "classes.pass.h"
};
#include "shared/constants.glsl"
#include "shared/sun.glsl"

bool is_picture(ivec2 size) { return size == ivec2(frame.size.xy); }

// 0 on a plane, and where the curvature is invalid.
float bent_part(float per_m) { return per_m > 0.0 ? min(0.001 * bent_mm * per_m, 1.0) : 0.0; }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(skin_width)))) return;
    bool by_class = stencil && frame.skin.z != 0u && is_picture(textureSize(stencil_full, 0));
    bool by_mask = mask && is_picture(textureSize(skin_strength, 0));
    float depth_m = texelFetch(depth_full, pixel, 0).x, width = by_class || by_mask ? 1.0 : 0.0;
    if (by_class && (texelFetch(stencil_full, pixel, 0).x & frame.skin.y) != frame.skin.x) width = 0.0;
    if (by_mask) width *= valid_mask(texelFetch(skin_strength, pixel, 0).x);
    if (curvature && is_picture(textureSize(skin_curvature, 0))) width *= 1.0 - (1.0 - flat_part) * (1.0 - bent_part(texelFetch(skin_curvature, pixel, 0).x));
    imageStore(skin_width, pixel, vec4(depth_m > 0.0 && depth_m < LARGEST ? width : 0.0));
}
