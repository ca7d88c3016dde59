// Edges between the texels of a level, four in a byte with two bits each: how much neighbours belong to one surface, in thirds. Levels are
// those of downsample/mips: texel t covers the texels 2t and 2t + 1 of the finer level, and an odd last row or column belongs to none.
#ifndef GLINT_EDGES
#define GLINT_EDGES

const uint SIDE_LEFT = 0u, SIDE_RIGHT = 1u, SIDE_UP = 2u, SIDE_DOWN = 3u;

float open_side(uint edges, uint side) { return float(edges >> 2u * side & 3u) / 3.0; }

uint packed_side(float open, uint side) { return uint(clamp(open, 0.0, 1.0) * 3.0 + 0.5) << 2u * side; }

// How much each texel of a 2x2 block belongs to the surface of its texel `from`, both as x + 2y; diagonally by the better of both paths.
// edges: of the block's texels, in that order.
vec4 open_in_block(uvec4 edges, uint from) {
    vec2 across = vec2(open_side(edges.x, SIDE_RIGHT), open_side(edges.z, SIDE_RIGHT));
    vec2 down = vec2(open_side(edges.x, SIDE_DOWN), open_side(edges.y, SIDE_DOWN));
    uint x = from & 1u, y = from >> 1u;
    vec4 open;
    open[from] = 1.0;
    open[from ^ 1u] = across[y];
    open[from ^ 2u] = down[x];
    open[from ^ 3u] = max(across[y] * down[x ^ 1u], down[x] * across[y ^ 1u]);
    return open;
}

// The texel of its 2x2 block, x + 2y, that a texel of a coarser level was picked from. place: of its pixel within the texel, x + 8y.
uint picked_in_block(uint place, int level) { return (place >> level & 1u) | (place >> 3 + level & 1u) << 1; }
#endif
