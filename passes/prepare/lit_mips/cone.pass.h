/* Each level filtered with the lobe of a cone that spans texel_scale of its pixels. */
PASS("Pre-filtered for cones", "Mafia III talk, Current approach; Pre-filtering cube-maps")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
SELF(texture2D, finer_color, lit_mips)
SPEC(bool,  apart,       true, 0,   1,    "1", "glint", "the sky is left out of every level, and alpha is the share of what is not sky; off: it is mixed in, and alpha is 1")
SPEC(int,   reach,       3,   0,    8,    "texels", "Mafia III talk, MIP pre-filtering", "taps are the texels up to this far: 3: 29 taps; 0: none, the box filter alone")
PUSH(float, texel_scale, 3.5, 0.25, 64.0, "texels", "Mafia III talk, Pre-filtering cube-maps", "radius of the cone for which a level stands, half a texel beyond the last tap; resolve's must be the same")
PUSH(float, threshold,   0.1, 0.001, 0.999, "1", "Mafia III talk, Combining importance sampling with pre-filtering", "value of the lobe at that radius")
DISPATCH_LEVELS(lit_mips, 0, -1, down)
