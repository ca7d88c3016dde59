/* A running mean for as long as the surface was visible and the view direction changed little for its roughness. */
PASS("History for rough surfaces", "Mafia III talk, Temporal filter")
#include "slot.h"
#include "history_rows.h"
#line 602
NEEDS_BY(rough, min_roughness)
DISPATCH_LIST_BY(tile_list, rough, min_roughness)
PUSH(float, min_roughness, 0.0, 0.0, 1.0, "1", "Mafia III talk, Temporal filter", "surfaces smoother than this have no history here and use no neighbours' samples, because temporal_sharp stabilizes them; 0: all have a history")
SPEC(bool,  extra,         true, 0,   1,    "1", "Mafia III talk, Temporal filter", "without a history, four more samples are taken at the centres of the neighbouring pluses; off: only the pixel's own")
SPEC(bool,  brdf,          true, 0,   1,    "1", "Mafia III talk, Neighbor sample reuse", "weight those by the lobe's value at their normals; off: equal weights for all that are not across a discontinuity")
