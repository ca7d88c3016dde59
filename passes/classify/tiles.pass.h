/* A list ordered by class, compacted by prefix sums over tiles. */
PASS("Compacted list", "000, Step-by-step recap (stencil mask based on roughness)")
#include "slot.h"
#line 202
WRITE(uimage2D, screen_tiles,  R32UI, "1", LIST, "counts", 0xFFFFFFFFu, "pixels of each class in each 8x8 tile")
WRITE(uimage2D, screen_groups, R32UI, "1", LIST, "counts", 0xFFFFFFFFu, "the same in 64 tiles")
SELF(utexture2D, tiles, screen_tiles)
SELF(utexture2D, groups, screen_groups)
PUSH(float, hq_roughness, 0.1, 0.0, 1.0, "1", "000, Cube-map tracing", "largest roughness of a smooth surface; order alone depends on it, no result")
DISPATCH(depth_half)
DISPATCH(screen_tiles)
DISPATCH(depth_half)
