/* What every variant of this slot reads and writes. */
#line 102
SLOT("Water over the picture")
READ(texture2D, composed)
READ(texture2D, water_depth)
READ(texture2D, water_normal)
READ(texture2D, water_color)
OPTIONAL_READ(texture2D, planar_reflection, RGBA16F, FULL, 0)
READ(textureCubeArray, cubemap_color)
READ(textureCube, sky)
WRITE(image2D, composed_water, RGBA16F, "radiance", FULL, "R G B A", 0, "composed, with the water over it; a is 1")
DISPATCH(composed_water)
DISPATCH_TILES(shown)
#include "shared/water_tile_rows.h"
NEEDS(water)
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
