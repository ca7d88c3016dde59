/* Builds the list block by block: in one dispatch, but with more workgroups for its readers. */
PASS("Lists of blocks", "Mafia III talk, Step-by-step recap (stencil mask based on roughness)")
#include "slot.h"
#line 202
DISPATCH(screen_list)
