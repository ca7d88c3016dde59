/* No march: the paraboloids are sampled in the ray's direction. */
PASS("Lookup in dual paraboloids", "GTA V article, Cubemap to Dual-Paraboloid Map")
#include "slot.h"
#line 202
OPTIONAL_READ(utextureBuffer, cubemap_list, R32UI, LIST, 0xFFFFFFFFu)
DISPATCH_LIST(cubemap_list)
READ(texture2DArray, paraboloids)
