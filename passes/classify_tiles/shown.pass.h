/* A tile shows reflections when one of its pixels does. */
PASS("Compacted list of tiles", "000, Step-by-step recap (stencil mask based on roughness)")
#include "slot.h"
#include "shared/shown_rows.h"
WORKGROUP(16, 16)
#line 202
READ(texture2D, depth_full)
READ(texture2D, normal_full)
SELF(utextureBuffer, marked, tile_list)
DISPATCH(depth_full)
DISPATCH(tile_list)
