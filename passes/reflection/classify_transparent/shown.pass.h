/* A tile shows transparent surfaces if one of its pixels does. */
PASS("Compacted list of tiles", "glint")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
READ(texture2D, transparent_color)
READ_OWN(utextureBuffer, marked, transparent_tiles)
DISPATCH(transparent_tiles)
DISPATCH(transparent_tiles)
