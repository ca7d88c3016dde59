/* Visits every texel that a ray crosses, one after the other: nothing is skipped. */
PASS("DDA over every texel", "KF2 article (mentioned only); McGuire and Mara 2014")
#include "slot.h"
#include "screen_rays/cell_rows.h"
#line 302
SPEC(int,   cells,       4096,  1,   65536, "texels", "McGuire and Mara 2014", "max texels visited")
REFERENCE
REFERENCE_SET(screen_trace, thickness, 0.01)
REFERENCE_SET(screen_trace, solid, 32)
