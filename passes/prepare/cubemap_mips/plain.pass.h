/* Chains without a pre-filter: each level is the box filter of the finer one. */
PASS("Box filter", "Mafia III talk, Pre-filtering cube-maps (regular MIP chain)")
#include "slot.h"
#line 202
READ_OWN(texture2DArray, finer_faces, cubemap_color_mips)
READ_OWN(texture2DArray, finer_distance, cubemap_distance_mips)
#include "shared/join_rows.h"
DISPATCH_LEVELS(cubemap_color_mips, 0, -1, down)
REFERENCE
