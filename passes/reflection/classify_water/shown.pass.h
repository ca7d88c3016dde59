/* A tile shows water if one of its pixels does. */
PASS("Compacted list of tiles", "glint")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
READ(texture2D, water_depth)
READ_OWN(utextureBuffer, marked, water_tiles)
DISPATCH(water_tiles)
DISPATCH(water_tiles)
