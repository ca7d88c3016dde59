#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "pick.pass.h"
#include "shared/push_begin.glsl"
#include "pick.pass.h"
};
#include "choose.glsl"
#include "surface.glsl"

void main() {
    ivec2 pixel = tile_texel(2.0);
    if (any(greaterThanEqual(pixel, imageSize(depth_half)))) return;
    ivec2 block = 2 * pixel, last = ivec2(frame.size.xy) - 1;
    vec4 inverse_depth;
    for (int i = 0; i < 4; ++i) {
        float depth_m = texelFetch(depth_full, min(block + ivec2(i & 1, i >> 1), last), 0).x;
        inverse_depth[i] = depth_m > 0.0 ? 1.0 / depth_m : 0.0;
    }
    uint shown = useful_in_block(block, inverse_depth), chosen = choose(block, inverse_depth, shown, ivec2(frame.size.xy));
    ivec2 source = block + ivec2(chosen & 1u, chosen >> 1u);

    store_surface(pixel, texelFetch(depth_full, source, 0).x, texelFetch(normal_full, source, 0), chosen, (shown >> chosen & 1u) != 0u);
}
