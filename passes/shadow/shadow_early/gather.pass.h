/* The mask at an eighth of the resolution, then the least of nine texels by four gathers. */
PASS("Least visibility of blocks", "GTA V article, Shadows: depth-aware blur")
#include "slot.h"
#line 202
WRITE(image2D, shadow_eighth, R16F, "1", EIGHTH, "visibility", 0, "no pixel of this texel's block sees less of the sun")
READ_OWN(texture2D, eighth, shadow_eighth)
DISPATCH(shadow_eighth)
DISPATCH(shadow_early)
