/* What every variant of this slot reads and writes. */
#line 102
SLOT("The picture with reflections")
READ(texture2D, reflection)
OPTIONAL_READ(texture2D, reflection_sharp, RGBA16F, FULL, -1)
OPTIONAL_READ(texture2D, reflection_stable, RGBA16F, FULL, -1)
READ(texture2D, lit)
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(texture2D, albedo_full)
READ(texture2D, specular_full)
READ(texture2D, fresnel_full)
FACT(fresnel)
NEEDS(reflecting)
ALIAS(composed, lit)
WRITE(image2D, composed, RGBA16F, "radiance", FULL, "R G B A", 0, "lit plus the last reflection image times the environment BRDF; a is 1")
DISPATCH(composed)
DISPATCH_TILES(shown)
#include "shared/tile_rows.h"
