/* The four nearest texels, blind to depth and normal. */
PASS("Bilinear", "Mafia III talk, Upscale (what it improves on)")
#include "slot.h"
DISPATCH(reflection)
DISPATCH_TILES(shown)
SPEC(bool, skip_empty, true, 0, 1, "1", "glint", "leave texels without a ray out of the mixture; off: they darken their neighbours")
REFERENCE
