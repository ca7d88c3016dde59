/* A running mean as long as the surface was seen and the view did not turn too far for its roughness. */
PASS("History for rough surfaces", "000, Temporal filter")
#include "slot.h"
#include "history_rows.h"
#line 602
SPEC(bool,  extra,         true, 0,   1,    "1", "000, Temporal filter", "where there is no history, four more samples at the centres of the neighbouring pluses; off: the pixel's own")
SPEC(bool,  brdf,          true, 0,   1,    "1", "000, Neighbor sample reuse", "weigh those by the lobe's value at their normals; off: all that are no discontinuity alike")
