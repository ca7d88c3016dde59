#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "pick.pass.h"
#include "shared/push_begin.glsl"
#include "pick.pass.h"
};
#include "downsample/surface.glsl"

// Which pixel of the block a frame prefers; a diagonal first, so that two frames already cover both rows and columns.
const uint PREFERRED[4] = uint[](0u, 3u, 1u, 2u);

bool inside(uint candidate, ivec2 block) {
    return block.x + int(candidate & 1u) < int(frame.size.x) && block.y + int(candidate >> 1u) < int(frame.size.y);
}

// The pixel that stands for the block. Inverse depth, 0 for sky and for depths that are none, so that sky is on the far side.
uint choose(ivec2 block, vec4 inverse_depth) {
    float near = 0.0, far = LARGEST;
    uint present = 0u, near_side = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        if (!inside(i, block)) continue;
        present |= 1u << i;
        near = max(near, inverse_depth[i]);
        far = min(far, inverse_depth[i]);
    }
    if (edges && near > far * (1.0 + edge_depth)) {
        for (uint i = 0u; i < 4u; ++i)
            if (2.0 * inverse_depth[i] > near + far) near_side |= 1u << i;
        near_side &= present;
        bool near_wins = 2 * bitCount(near_side) >= bitCount(present);
        if (tie == tie_split && (near_side == 6u || near_side == 9u)) near_wins = ((block.x ^ block.y) & 2) == 0;
        present = near_wins ? near_side : present & ~near_side;
    }
    uint preferred = alternate ? PREFERRED[frame.counts.y & 3u] : 0u;
    for (uint i = 0u; i < 4u; ++i)
        if ((present & 1u << (preferred ^ i)) != 0u) return preferred ^ i;
    return 0u;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth_half)))) return;
    ivec2 block = 2 * pixel, last = ivec2(frame.size.xy) - 1;
    vec4 inverse_depth;
    for (int i = 0; i < 4; ++i) {
        float depth_m = texelFetch(depth_full, min(block + ivec2(i & 1, i >> 1), last), 0).x;
        inverse_depth[i] = depth_m > 0.0 ? 1.0 / depth_m : 0.0;
    }
    uint chosen = choose(block, inverse_depth);
    ivec2 source = block + ivec2(chosen & 1u, chosen >> 1u);

    store_surface(pixel, texelFetch(depth_full, source, 0).x, texelFetch(normal_full, source, 0), chosen);
}
