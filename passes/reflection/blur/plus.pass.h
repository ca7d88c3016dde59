/* Weights the five samples of a plus shape, one of each class of the pattern plus of downsample. */
PASS("Five samples, BRDF-weighted", "Mafia III talk, Neighbor sample reuse")
#include "slot.h"
#line 202
SPEC(bool, brdf, true, 0, 1, "1", "Mafia III talk, Neighbor sample reuse", "weight neighbours by the lobe's value at their normals; off: equal weights for all that are not across a discontinuity")
#include "shared/reuse_rows.h"
NEEDS_BY(rough, fade_from)
DISPATCH(reflection_blurred)
DISPATCH_LIST_BY(tile_list, rough, fade_from)
