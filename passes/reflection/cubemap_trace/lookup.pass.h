/* No march: the cube map is sampled in the ray's direction, as if everything in it were infinitely far away. */
PASS("Lookup by direction", "Mafia III talk, Existing solutions")
#include "slot.h"
#line 202
