/* A tile shows reflections when one of its pixels does. */
PASS("Compacted list of tiles", "Mafia III talk, Step-by-step recap (stencil mask based on roughness)")
#include "slot.h"
#include "shared/shown_rows.h"
WORKGROUP(16, 16)
#line 202
READ(texture2D, depth_full)
READ(texture2D, normal_full)
SELF(utextureBuffer, marked, tile_list)
PUSH(float, max_coverage, 0.75, 0.0, 1.0, "1", "chosen by measuring", "largest part of the pixels that may show reflections: where there are more, a list leaves out less than it costs")
NEEDS_BY(sparse, max_coverage)
DISPATCH(tile_list)
DISPATCH(tile_list)
