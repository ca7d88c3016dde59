/* How a list of tiles lies in memory, read by C and GLSL. For each range of tile_ranges.h, one after the other, three
   quadruples: the workgroups that an indirect dispatch over it starts, with 2, 4 and 8 strips to each of them, and how many tiles
   they are for. A strip is 16x2 pixels, eight tiles side by side. The order is that of the picture's regions, column of strips by
   column within one: what a workgroup works on lies together.
   Another list may follow, of tiles that are whole strips. Their rows are eight texels, whatever the image's resolution: as many as
   llvmpipe works on at once. */
#ifndef GLINT_TILE_LIST
#define GLINT_TILE_LIST
#define TILE_WIDE 2     /* pixels of the picture */
#define TILE_HIGH 2
#define STRIP_WIDE 16
#define REGION_WIDE 4   /* strips, of which a workgroup of the maker lists all */
#define REGION_HIGH 16
#define TILE_RANGES 128 /* place of each range's first tile and number of tiles */
#define TILE_NEXT 255   /* place that says where another list begins, if the buffer holds one */
#define TILE_ITEMS 256  /* place of the tiles, x + 65536 y */
/* Tiles of a region; words of a list with what its maker notes behind it: four bits of each tile, two words of each region. */
#define TILE_REGION(wide) (REGION_WIDE * REGION_HIGH * STRIP_WIDE / (wide))
#define TILE_WORDS(regions, wide) (TILE_ITEMS + (regions) * (TILE_REGION(wide) / 8 * 9 + 2))
#endif
