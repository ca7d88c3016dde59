#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "nearest.pass.h"
#include "shared/push_begin.glsl"
#include "nearest.pass.h"
};
#include "shared/facet_at.glsl"

const float NO_SURFACE = -1.0; // no ray can be behind it
const vec2 EMPTY = vec2(NO_SURFACE, LARGEST);

vec2 join(vec2 range, vec2 cell) { return vec2(max(range.x, cell.x), min(range.y, cell.y)); }

// A cell of level 0.
vec2 facet_range(ivec2 at) {
    float depth_m = texelFetch(depth_half, at, 0).x;
    vec2 slopes = facet_slopes_at(at, depth_m);
    imageStore(depth_slopes, at, vec4(slopes, 0.0, 0.0));
    // The slopes are rounded to half, which moves the rise by less than a thousandth of it.
    float rise = 1.001 * facet_rise(slopes), fall = 2.0 * rise;
    float inverse = depth_m < LARGEST ? min(1.0 / depth_m, LARGEST) : 0.0; // that of a denormal depth is infinite
    return inverse > 0.0 ? inverse * vec2(1.000001 + rise, max(1.0 - fall, 0.0)) : vec2(NO_SURFACE, 0.0);
}

// The last of the finer cells that a cell covers: two along each axis, and a third one at the end if the finer level's size is odd. All relative
// to a tile; `ends`: for each axis 1 where the tile ends with the image.
ivec2 last_child(ivec2 cell, ivec2 cells, ivec2 finer_cells, ivec2 ends) {
    return min(2 * cell + 1 + ends * ivec2(equal(cell, cells - 1)), finer_cells - 1);
}

// A cell of the dispatch's level, from the finer level in memory.
vec2 read_range(ivec2 at, ivec2 size) {
    int level = int(dispatch_level) - 1;
    ivec2 last = last_child(at, size, textureSize(finer, level), ivec2(1));
    vec2 range = EMPTY;
    for (int y = 2 * at.y; y <= last.y; ++y)
        for (int x = 2 * at.x; x <= last.x; ++x) range = join(range, texelFetch(finer, ivec2(x, y), level).xy);
    return range;
}

vec2 store_range(ivec2 at, ivec2 size) {
    vec2 range = dispatch_phase == 0u ? facet_range(at) : read_range(at, size);
    imageStore(hiz, at, vec4(range, 0.0, 0.0));
    return range;
}

// With a chain, a workgroup makes a tile of 16 x 16 cells of the dispatch's level, and of these those of the next four levels; the last one along an axis also
// what remains there, less than another tile.
const int TILE = 16, MOST = 2 * TILE - 1, HALF_MOST = MOST / 2;
shared vec2 cells_a[MOST * MOST], cells_b[HALF_MOST * HALF_MOST]; // of one level and of the next

#define COARSER(n, from, from_wide, to, to_wide)                                                                   \
    barrier();                                                                                                     \
    if (int(dispatch_level) + n >= levels) return;                                                                 \
    finer_cells = cells;                                                                                           \
    cells = max((first + tile_cells) >> n, 1) - (first >> n);                                                      \
    if (all(lessThan(local, cells))) {                                                                             \
        ivec2 last = last_child(local, cells, finer_cells, ends);                                                  \
        vec2 range = EMPTY;                                                                                        \
        for (int y = 2 * local.y; y <= last.y; ++y)                                                                \
            for (int x = 2 * local.x; x <= last.x; ++x) range = join(range, from[y * from_wide + x]);              \
        to[local.y * to_wide + local.x] = range;                                                                   \
        imageStore(hiz_levels[n], (first >> n) + local, vec4(range, 0.0, 0.0));                                    \
    }

void main() {
    ivec2 size = imageSize(hiz), at = ivec2(gl_GlobalInvocationID.xy);
    if (CHAIN == 1) {
        if (all(lessThan(at, size))) store_range(at, size);
        return;
    }
    ivec2 tile = ivec2(gl_WorkGroupID.xy), tiles = max(size / TILE, 1);
    if (any(greaterThanEqual(tile, tiles))) return;
    int levels = textureQueryLevels(finer);
    ivec2 local = ivec2(gl_LocalInvocationID.xy), first = TILE * tile, ends = ivec2(equal(tile, tiles - 1));
    ivec2 tile_cells = mix(ivec2(TILE), size - first, bvec2(ends)), cells = tile_cells, finer_cells;
    for (int y = local.y; y < cells.y; y += TILE)
        for (int x = local.x; x < cells.x; x += TILE) cells_a[y * MOST + x] = store_range(first + ivec2(x, y), size);
    COARSER(1, cells_a, MOST, cells_b, HALF_MOST)
    COARSER(2, cells_b, HALF_MOST, cells_a, MOST)
    COARSER(3, cells_a, MOST, cells_b, HALF_MOST)
    COARSER(4, cells_b, HALF_MOST, cells_a, MOST)
}
