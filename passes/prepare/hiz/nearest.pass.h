/* A cell covers all of its children: sizes are rounded down, and the last cell of a row also covers the remaining texels. */
PASS("Nearest and farthest depth", "KF2 article, HZB Optimization (nearest depth only)")
#include "slot.h"
#line 202
READ_OWN(texture2D, finer, hiz)
WRITE_LEVELS(image2D, hiz_levels, hiz)
DISPATCH(depth_slopes)
DISPATCH_CHAIN(hiz)
WORKGROUP(16, 16)
