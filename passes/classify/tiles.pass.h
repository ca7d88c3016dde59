/* A list ordered by class, compacted by prefix sums over blocks. */
PASS("Compacted list", "000, Step-by-step recap (stencil mask based on roughness)")
#include "slot.h"
#line 202
SELF(utextureBuffer, marked, screen_list)
PUSH(float, hq_roughness, 0.1, 0.0, 1.0, "1", "000, Cube-map tracing", "largest roughness of a smooth surface; order alone depends on it, no result")
DISPATCH(screen_list)
DISPATCH(screen_list)
