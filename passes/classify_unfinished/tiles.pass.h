/* A list ordered by class, compacted by prefix sums over blocks. */
PASS("Compacted list", "000, Step-by-step recap (stencil mask for SSR finished pixels)")
#include "slot.h"
#line 202
SELF(utextureBuffer, marked, cubemap_list)
PUSH(float, hq_roughness, 0.1, 0.0, 1.0, "1", "000, Cube-map tracing", "largest roughness of a smooth surface; order alone depends on it, no result")
DISPATCH(cubemap_list)
DISPATCH(cubemap_list)
