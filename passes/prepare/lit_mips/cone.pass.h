/* Each level is filtered with the lobe of a cone whose radius is texel_scale of its pixels. */
PASS("Pre-filtered for cones", "Mafia III talk, Current approach; Pre-filtering cube-maps")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
READ_OWN(texture2D, finer_color, lit_mips)
SPEC(bool,  exclude_sky, true, 0,   1,    "1", "glint", "the sky is excluded from every level and alpha is the fraction that is not sky; off: the sky is mixed in and alpha is 1")
SPEC(int,   reach,       3,   0,    8,    "texels", "Mafia III talk, MIP pre-filtering", "radius of the filter in texels: 3 gives 29 taps; 0: box filter only")
PUSH(float, texel_scale, 3.5, 0.25, 64.0, "texels", "Mafia III talk, Pre-filtering cube-maps", "radius of the cone that a level represents, half a texel beyond the last tap; must equal resolve.texel_scale")
PUSH(float, threshold,   0.1, 0.001, 0.999, "1", "Mafia III talk, Combining importance sampling with pre-filtering", "value of the lobe at that radius, relative to its peak")
DISPATCH_LEVELS(lit_mips, 0, -1, down)
