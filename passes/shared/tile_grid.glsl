// The picture's tiles.
#ifndef GLINT_TILE_GRID
#define GLINT_TILE_GRID
#include "shared/tile_list.h"

uvec2 tile_grid(uvec2 size) { return (size + uint(TILE) - 1u) / uint(TILE); }
uint tile_count(uvec2 size) { return tile_grid(size).x * tile_grid(size).y; }
#endif
