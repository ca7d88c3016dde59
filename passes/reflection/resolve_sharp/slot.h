/* What every variant of this slot reads and writes. */
#line 102
SLOT("Colour at full resolution where surfaces are smooth")
READ(texture2D, reflection)
READ(texture2D, depth_half)
READ(utexture2D, pick)
READ(texture2D, normal_full)
WRITE(image2D, reflection_sharp, RGBA16F, "radiance", FULL, "R G B A", -1, "reflection, with smooth surfaces resolved at full resolution")
DISPATCH(reflection_sharp)
NEEDS(reflecting)
REFERENCE_NONE("every pixel of the reference has its own rays")
REFERENCE_WITH(upscale, "it replaces the pixels that upscale marks")
#include "shared/shown_rows.h"
