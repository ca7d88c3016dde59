/* No march: the cube map is looked up in the ray's direction, as if all it shows were infinitely far. */
PASS("Lookup by direction", "Mafia III talk, Existing solutions")
#include "slot.h"
#line 202
OPTIONAL_READ(utextureBuffer, cubemap_list, R32UI, LIST, 0xFFFFFFFFu)
DISPATCH_LIST(cubemap_list)
