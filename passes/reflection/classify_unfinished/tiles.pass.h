/* Builds one list ordered by class, compacted with prefix sums over blocks. */
PASS("Compacted list", "Mafia III talk, Step-by-step recap (stencil mask for SSR finished pixels)")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
READ_OWN(utextureBuffer, marked, cubemap_list)
DISPATCH(cubemap_list)
DISPATCH(cubemap_list)
