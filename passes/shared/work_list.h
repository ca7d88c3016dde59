/* The layout of a list of tiles, for C and GLSL. Its items are the tiles of 2x2 pixels of the picture, as x + 65536 y. They are sorted
   into four kinds: with rough surfaces only, with rough and smooth ones, with smooth ones only, without work. A pass runs over a range
   of the list with one dispatch, and over the rest with another. The list starts with three quadruples for each range and each rest:
   the workgroup counts of an indirect dispatch with 16, 32 or 64 tiles in a workgroup, and the number of tiles. Tiles of a kind are
   ordered by regions of the picture, in a region by columns of strips, in a strip along x, so that the tiles of a workgroup are close
   together. */
#ifndef GLINT_WORK_LIST_H
#define GLINT_WORK_LIST_H
#define TILE_WIDE 2     /* width and height of a tile in pixels of the picture */
#define STRIP_TILES 8   /* tiles side by side in a strip: at half resolution the 8 texels that llvmpipe computes at a time */
#define REGION_COLUMNS 4 /* strips side by side in a region, whose tiles one workgroup lists */
#define REGION_ROWS 32
#define REGION_TILES (REGION_COLUMNS * REGION_ROWS * STRIP_TILES)
#define REGION_WIDE 64 /* width and height of a region in pixels */
#define RANGE_shown 0  /* the ranges; each is followed by its rest */
#define RANGE_smooth 2 /* surfaces up to the highest roughness of a row DISPATCH_LIST_BY */
#define RANGE_rough 4  /* surfaces from the lowest roughness of such a row */
#define RANGES 6
#define LIST_RANGES 128 /* index of the word with the first tile of range 0; its number of tiles follows, then the other ranges */
#define LIST_ITEMS 256  /* index of the first tile */
/* The number of words of a list with its scratch space: four bits for each tile, two words for each region. */
#define LIST_WORDS(regions) (LIST_ITEMS + (regions) * (REGION_TILES / 8 * 9 + 2))
#endif
