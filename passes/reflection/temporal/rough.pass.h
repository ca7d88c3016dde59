/* A running mean as long as the surface was seen and the view did not turn too far for its roughness. */
PASS("History for rough surfaces", "Mafia III talk, Temporal filter")
#include "slot.h"
#include "history_rows.h"
#line 602
NEEDS_BY(rough, min_roughness)
DISPATCH_TILES_BY(rough, min_roughness)
PUSH(float, min_roughness, 0.0, 0.0, 1.0, "1", "Mafia III talk, Temporal filter", "smoother surfaces have no history here, and take no samples of others: what steadies them at full resolution does it alone; 0: all have")
SPEC(bool,  extra,         true, 0,   1,    "1", "Mafia III talk, Temporal filter", "where there is no history, four more samples at the centres of the neighbouring pluses; off: the pixel's own")
SPEC(bool,  brdf,          true, 0,   1,    "1", "Mafia III talk, Neighbor sample reuse", "weigh those by the lobe's value at their normals; off: all that are no discontinuity alike")
