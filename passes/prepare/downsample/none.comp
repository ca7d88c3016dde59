#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "none.pass.h"
#include "shared/push_begin.glsl"
#include "none.pass.h"
};
#include "surface.glsl"

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(depth_half)))) return;
    store_surface(pixel, texelFetch(depth_full, pixel, 0).x, texelFetch(normal_full, pixel, 0), 0u, tile_works && is_shown(pixel));
}
