/* The running mean, of what is left when single bright samples are taken down to what is around them. */
PASS("History without outliers", "Mafia DE article, Global Illumination; Temporal AA")
#include "slot.h"
#include "history_rows.h"
#line 602
DISPATCH_TILES(shown)
OPTIONAL_READ(texture2D, reflection_levels, RGBA16F, HALF_MIPS3, 0)
SPEC(bool,  brdf,    true, 0,   1,    "1", "Mafia III talk, Neighbor sample reuse", "weigh the neighbours that make what is around by the lobe's value at their normals; off: all that are no discontinuity alike")
PUSH(float, outlier, 3.0,  1.0, 1e6,  "1", "Mafia DE article, Temporal AA; chosen by measuring", "a sample is held at this many times the luminance around it: of the coarsest level of reflection_levels, or without one the mean of its four neighbours; 1e6: not at all")
