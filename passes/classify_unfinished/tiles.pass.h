/* A list ordered by class, compacted by prefix sums over tiles. */
PASS("Compacted list", "000, Step-by-step recap (stencil mask for SSR finished pixels)")
#include "slot.h"
#line 202
WRITE(uimage2D, cubemap_tiles,  R32UI, "1", LIST, "counts", 0xFFFFFFFFu, "pixels of each class in each 8x8 tile")
WRITE(uimage2D, cubemap_groups, R32UI, "1", LIST, "counts", 0xFFFFFFFFu, "the same in 64 tiles")
SELF(utexture2D, tiles, cubemap_tiles)
SELF(utexture2D, groups, cubemap_groups)
PUSH(float, hq_roughness, 0.1, 0.0, 1.0, "1", "000, Cube-map tracing", "largest roughness of a smooth surface; order alone depends on it, no result")
DISPATCH(depth_half)
DISPATCH(cubemap_tiles)
DISPATCH(depth_half)
