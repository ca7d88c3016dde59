/* A tile has rays left if one of its rays did not end on screen. */
PASS("Compacted list of tiles", "Mafia III talk, Step-by-step recap (stencil mask for SSR finished pixels)")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
READ_OWN(utextureBuffer, marked, cubemap_list)
DISPATCH(cubemap_list)
DISPATCH(cubemap_list)
