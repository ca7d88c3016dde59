/* A parent covers all its children: sizes are rounded down, and the last cell of a row takes what is left over. */
PASS("Nearest depth", "002, HZB Optimization")
#include "slot.h"
#line 202
SELF(texture2D, finer, hiz)
DISPATCH(depth_slopes)
DISPATCH_LEVELS(hiz, 1, -3, down)
