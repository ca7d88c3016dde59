// Chooses the pixel that represents a 2x2 block. Next include of a pass with the rows of pick_rows.h.
#include "shared/constants.glsl"

// The pixel of the block that a frame prefers. Diagonal pixels come first, so that two frames already cover both rows and columns.
const uint PREFERRED[4] = uint[](0u, 3u, 1u, 2u);

bool inside(uint candidate, ivec2 block, ivec2 size) {
    return all(lessThan(block + ivec2(candidate & 1u, candidate >> 1u), size));
}

// The pixel that represents the block. It compares inverse depths, which are 0 for sky and invalid depths, so that sky is on the far side.
// useful: mask of the pixels with a visible reflection, which are preferred to others on their side of a discontinuity.
// size: of the full-resolution image.
uint choose(ivec2 block, vec4 inverse_depth, uint useful, ivec2 size) {
    float near = 0.0, far = LARGEST;
    uint present = 0u, near_side = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        if (!inside(i, block, size)) continue;
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
    if ((present & useful) != 0u) present &= useful;
    uint preferred = alternate ? PREFERRED[frame.counts.y & 3u] : 0u;
    for (uint i = 0u; i < 4u; ++i)
        if ((present & 1u << (preferred ^ i)) != 0u) return preferred ^ i;
    return 0u;
}
