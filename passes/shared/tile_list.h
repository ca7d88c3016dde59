/* How a list of tiles lies in memory, read by C and GLSL. For each range of tile_ranges.h, one after the other, three
   quadruples: the workgroups that an indirect dispatch over it starts, with 1, 2 and 4 of them to a tile (in z), and how many
   tiles they are for. */
#ifndef GLINT_TILE_LIST
#define GLINT_TILE_LIST
#define TILE 16         /* pixels of the picture across */
#define TILE_RANGES 128 /* place of each range's first tile and number of tiles */
#define TILE_ITEMS 256  /* place of the tiles, x + 65536 y */
#endif
