/* How a list of tiles lies in memory, read by C and GLSL. For each range of tile_ranges.h, one after the other, three
   quadruples: the workgroups that an indirect dispatch over it starts, with 2, 4 and 8 tiles to each of them, and how many tiles
   they are for. The tiles' order is that of the picture's regions, and column by column within one: what a workgroup works on
   lies together. A row of a tile is eight texels, whatever the image's resolution: llvmpipe works on as many at once, and its lookups
   near the corners of cube maps round by what else is among them. */
#ifndef GLINT_TILE_LIST
#define GLINT_TILE_LIST
#define TILE_WIDE 16    /* pixels of the picture */
#define TILE_HIGH 2
#define REGION_WIDE 4   /* tiles, of which a workgroup of the maker lists all */
#define REGION_HIGH 16
#define TILE_RANGES 128 /* place of each range's first tile and number of tiles */
#define TILE_ITEMS 256  /* place of the tiles, x + 65536 y */
#endif
