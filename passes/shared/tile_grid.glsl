// The picture's tiles.
#ifndef GLINT_TILE_GRID
#define GLINT_TILE_GRID
#include "shared/tile_list.h"

#ifndef TILE_LIST // the list that a pass makes or goes by
#define TILE_LIST tile_list
#endif

const vec2 TILE_SIZE = vec2(TILE_WIDE, TILE_HIGH);
uvec2 tile_grid(uvec2 size) { return (size + uvec2(TILE_SIZE) - 1u) / uvec2(TILE_SIZE); }
uint tile_count(uvec2 size) { return tile_grid(size).x * tile_grid(size).y; }
#endif
