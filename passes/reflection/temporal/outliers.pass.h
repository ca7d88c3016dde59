/* A running mean in which isolated bright samples are clamped to their surroundings first. */
PASS("History without outliers", "Mafia DE article, Global Illumination; Temporal AA")
#include "slot.h"
#include "history_rows.h"
#line 602
DISPATCH_LIST(tile_list, shown)
OPTIONAL_READ(texture2D, reflection_levels, RGBA16F, HALF_MIPS(3), 0)
SPEC(bool,  brdf,    true, 0,   1,    "1", "Mafia III talk, Neighbor sample reuse", "weight the surrounding neighbours by the lobe's value at their normals; off: equal weights for all that are not across a discontinuity")
PUSH(float, outlier, 3.0,  1.0, 1e6,  "1", "Mafia DE article, Temporal AA; chosen by measuring", "samples are clamped to this many times the surrounding luminance, which is that of the coarsest level of reflection_levels or else the mean of the four neighbours; 1e6: no clamp")
