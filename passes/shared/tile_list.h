/* How a list of tiles lies in memory, read by C and GLSL. For each range of tile_ranges.h, one after the other, three
   quadruples: the workgroups that an indirect dispatch over it starts, with 2, 4 and 8 strips to each of them, and how many tiles
   they are for. A strip is one tile of 16x2 pixels or, where the device takes tiles of 2x2, eight of them side by side. The order is
   that of the picture's regions, column of strips by column within one: what a workgroup works on lies together.
   A strip's row is eight texels, whatever the image's resolution: llvmpipe works on as many at once, and its lookups near the corners
   of cube maps round by what else is among them. So there a tile is a strip. */
#ifndef GLINT_TILE_LIST
#define GLINT_TILE_LIST
#define STRIP_WIDE 16   /* pixels of the picture */
#define TILE_WIDE 2     /* where the device works on each texel by itself */
#define TILE_HIGH 2
#define REGION_WIDE 4   /* strips, of which a workgroup of the maker lists all */
#define REGION_HIGH 16
#define TILE_RANGES 128 /* place of each range's first tile and number of tiles */
#define TILE_ITEMS 256  /* place of the tiles, x + 65536 y */
#endif
