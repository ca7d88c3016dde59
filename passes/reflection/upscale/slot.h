/* What every variant of this slot reads and writes. */
#line 102
SLOT("Reflection at full resolution")
READ(texture2D, reflection_half)
OPTIONAL_READ(texture2D, reflection_blurred, RGBA16F, HALF, -1)
OPTIONAL_READ(texture2D, reflection_temporal, RGBA16F, HALF, -1)
READ(texture2D, depth_half)
READ(texture2D, normal_half)
READ(utexture2D, pick)
READ(texture2D, depth_full)
READ(texture2D, normal_full)
WRITE(image2D, reflection, RGBA16F, "radiance", FULL, "R G B A", 0, "the final half-resolution reflection at full resolution")
NEEDS(reflecting)
#include "shared/shown_rows.h"
