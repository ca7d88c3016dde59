/* The five samples of a plus, one of each class of downsample's pattern. */
PASS("Five samples, BRDF-weighted", "Mafia III talk, Neighbor sample reuse")
#include "slot.h"
#line 202
SPEC(bool, brdf, true, 0, 1, "1", "Mafia III talk, Neighbor sample reuse", "weigh neighbours by the lobe's value at their normals; off: all that are no discontinuity alike")
#include "shared/reuse_rows.h"
NEEDS_BY(rough, fade_from)
DISPATCH(reflection_blurred)
DISPATCH_TILES_BY(rough, fade_from)
