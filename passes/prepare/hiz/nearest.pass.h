/* A parent covers all its children: sizes are rounded down, and the last cell of a row takes what is left over. */
PASS("Nearest and farthest depth", "KF2 article, HZB Optimization, which has the nearest alone")
#include "slot.h"
#line 202
SELF(texture2D, finer, hiz)
DISPATCH(depth_slopes)
DISPATCH_LEVELS(hiz, 1, -1, down)
