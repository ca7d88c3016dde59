/* No march: the paraboloids are sampled in the ray's direction. */
PASS("Lookup in dual paraboloids", "GTA V article, Cubemap to Dual-Paraboloid Map")
#include "slot.h"
#line 202
READ(texture2DArray, paraboloids)
