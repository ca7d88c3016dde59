/* Each level filtered with the lobe of a cone that spans texel_scale of its pixels. */
PASS("Pre-filtered for cones", "000, Current approach; Pre-filtering cube-maps")
#include "slot.h"
#line 202
WRITE(image2D, lit_box, RGBA16F, "radiance", FULL_MIPS, "R G B A", 0, "the chain before the pre-filter")
SELF(texture2D, finer_color, lit_box)
#include "shared/prefilter_rows.h"
DISPATCH_LEVELS(lit_box, 0, -1, down)
DISPATCH_LEVELS(lit_mips, 0, -1, down)
