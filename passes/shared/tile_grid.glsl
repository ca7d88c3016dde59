// The picture's tiles.
#ifndef GLINT_TILE_GRID
#define GLINT_TILE_GRID
#include "shared/tile_list.h"

#ifndef TILE_LIST // the list that a pass makes or goes by
#define TILE_LIST tile_list
#endif

const uint STRIP_TILES = STRIP_WIDE / tile_wide;
const uvec2 TILE_SIZE = uvec2(tile_wide, TILE_HIGH);
uvec2 tile_grid(uvec2 size) { return (size + TILE_SIZE - 1u) / TILE_SIZE; }
uint tile_count(uvec2 size) { return tile_grid(size).x * tile_grid(size).y; }
#endif
