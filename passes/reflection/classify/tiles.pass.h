/* A tile has rays if a surface in it reflects. */
PASS("Compacted list of tiles", "Mafia III talk, Step-by-step recap (stencil mask based on roughness)")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
READ_OWN(utextureBuffer, marked, screen_list)
DISPATCH(screen_list)
DISPATCH(screen_list)
