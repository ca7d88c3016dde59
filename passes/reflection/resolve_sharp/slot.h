/* What every variant of this slot reads and writes. */
#line 102
SLOT("Colour at full resolution where surfaces are smooth")
READ(texture2D, reflection)
READ(texture2D, depth_half)
READ(utexture2D, pick)
READ(texture2D, normal_full)
WRITE(image2D, reflection_sharp, RGBA16F, "radiance", FULL, "R G B A", -1, "reflection, smooth surfaces resolved anew")
DISPATCH(reflection_sharp)
#include "shared/tile_rows.h"
NEEDS(reflecting)
REFERENCE_NONE("every pixel has rays of its own already")
REFERENCE_WITH(upscale, "it draws anew the pixels that upscale points out")
#include "shared/shown_rows.h"
