/* A cell covers all of its children: sizes are rounded down, and the last cell of a row also covers the remaining texels. */
PASS("Boxes along the world's axes", "glint")
#include "slot.h"
#line 202
READ_OWN(texture2D, low, bounds_low)
READ_OWN(texture2D, high, bounds_high)
DISPATCH_LEVELS(bounds_low, 0, -1, down)
