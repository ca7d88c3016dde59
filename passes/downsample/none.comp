#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "none.pass.h"
#include "shared/push_begin.glsl"
#include "none.pass.h"
};
#include "downsample/surface.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth_half)))) return;
    store_surface(pixel, texelFetch(depth_full, pixel, 0).x, texelFetch(normal_full, pixel, 0), 0u, is_shown(pixel));
}
