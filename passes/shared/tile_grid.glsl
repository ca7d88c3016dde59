// The picture's tiles.
#ifndef GLINT_TILE_GRID
#define GLINT_TILE_GRID
#include "shared/tile_list.h"

#ifndef TILE_LIST // the list that a pass makes or goes by
#define TILE_LIST tile_list
#endif

const uint STRIP_TILES = STRIP_WIDE / tile_wide;
const uvec2 TILE_SIZE = uvec2(tile_wide, TILE_HIGH);
const uvec2 REGION_SIZE = uvec2(REGION_WIDE * STRIP_WIDE, REGION_HIGH * TILE_HIGH); // pixels
uint region_count(uvec2 size) {
    uvec2 grid = (size + REGION_SIZE - 1u) / REGION_SIZE;
    return grid.x * grid.y;
}
// Where the list of the tiles begins that the pass takes.
int list_begin() { return tile_wide == TILE_WIDE ? 0 : int(TILE_WORDS(region_count(frame.size.xy), TILE_WIDE)); }
uvec2 tile_grid(uvec2 size) { return (size + TILE_SIZE - 1u) / TILE_SIZE; }
uint tile_count(uvec2 size) { return tile_grid(size).x * tile_grid(size).y; }
#endif
