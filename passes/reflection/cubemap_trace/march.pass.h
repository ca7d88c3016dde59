/* The march through distance cube maps of the Mafia III talk. */
PASS("March along the chain", "Mafia III talk, Cube-map tracing pseudo-code")
#include "slot.h"
#include "march_rows.h"
#line 302
ALONG_RAYS(cocoon_distance, normal_jittered)
ALONG_RAYS(cocoon, normal_jittered)
PUSH(float, max_roughness, 1.0, 0.0, 1.0, "1", "glint", "surfaces rougher than this are not marched but sampled by direction; 1: all are marched")
