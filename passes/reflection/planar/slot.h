/* What every variant of this slot reads and writes. */
#line 102
SLOT("Reflections of a plane, from a render of its own")
READ(texture2D, water_depth)
READ(texture2D, water_normal)
READ(texture2D, planar_color)
READ(texture2D, planar_depth)
WRITE(image2D, planar_reflection, RGBA16F, "radiance", FULL, "R G B A", 0, "rgb: radiance that arrives along the mirror ray; a: 1 where the map shows where it goes, 0 where it does not or there is no water")
DISPATCH(planar_reflection)
DISPATCH_TILES(shown)
#include "shared/water_tile_rows.h"
NEEDS(planar)
NEEDS(water)
REFERENCE_NONE("laid over the picture: no part of the reflection that a reference is of")
