/* How a list of work lies in memory, read by C and GLSL. Its items are tiles of 2x2 pixels of the picture, x + 65536 y, in four
   kinds one after the other: with rough surfaces alone, with both, with smooth ones alone, with nothing to do. Passes run over a range
   of them, and then over the rest. For each of the RANGES, and for the rest behind it, a list opens with three quadruples: the
   workgroups that an indirect dispatch over it starts, with 16, 32 and 64 tiles to each of them, and how many tiles they are for.
   Within a kind, tiles are ordered by the picture's regions, in a region by columns of strips, in a strip along x: what a
   workgroup works on lies together. */
#ifndef GLINT_WORK_LIST_H
#define GLINT_WORK_LIST_H
#define TILE_WIDE 2     /* pixels of the picture, either way */
#define STRIP_TILES 8   /* tiles of a strip, side by side: as many texels at half resolution as llvmpipe works on at once */
#define REGION_COLUMNS 4 /* strips side by side in a region, of which a workgroup of the maker lists all */
#define REGION_ROWS 32
#define REGION_TILES (REGION_COLUMNS * REGION_ROWS * STRIP_TILES)
#define REGION_WIDE 64 /* pixels, either way */
#define RANGE_shown 0  /* numbers of the ranges; behind each, that of the rest */
#define RANGE_smooth 2 /* up to the largest roughness of a row DISPATCH_LIST_BY */
#define RANGE_rough 4  /* from the least roughness of one */
#define RANGES 6
#define LIST_RANGES 128 /* place of each range's first tile and number of tiles */
#define LIST_ITEMS 256  /* place of the tiles */
/* Words of a list with what its maker notes behind it: four bits of each tile, two words of each region. */
#define LIST_WORDS(regions) (LIST_ITEMS + (regions) * (REGION_TILES / 8 * 9 + 2))
#endif
