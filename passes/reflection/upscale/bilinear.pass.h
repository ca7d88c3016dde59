/* Interpolates the four nearest texels, ignoring depth and normal. */
PASS("Bilinear", "Mafia III talk, Upscale (the baseline)")
#include "slot.h"
DISPATCH(reflection)
DISPATCH_LIST(tile_list, shown)
SPEC(bool, skip_empty, true, 0, 1, "1", "glint", "exclude texels without a ray from the interpolation; off: they darken their neighbours")
REFERENCE
