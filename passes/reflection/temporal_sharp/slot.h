/* What every variant of this slot reads and writes. */
#line 102
SLOT("Full-resolution reflections of several frames")
READ(texture2D, reflection)
OPTIONAL_READ(texture2D, reflection_sharp, RGBA16F, FULL, -1)
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(texture2D, motion_full)
READ(texture2D, travelled)
OPTIONAL_READ(utexture2D, pick, R8UI, HALF, 4)
WRITE(image2D, reflection_stable, RGBA16F, "radiance", FULL, "R G B A", -1, "reflection_sharp with what earlier frames had of smooth surfaces; a: 0 where no frame found a source, which is no history")
DISPATCH(reflection_stable)
#include "shared/tile_rows.h"
NEEDS(reflecting)
REFERENCE_NONE("a frame has rays enough of its own")
REFERENCE_WITH(resolve_sharp, "it steadies what resolve_sharp draws")
#include "shared/shown_rows.h"
