/* A tile shows reflections if one of its pixels does. */
PASS("Compacted list of tiles", "Mafia III talk, Step-by-step recap (stencil mask based on roughness)")
#include "slot.h"
#include "shared/shown_rows.h"
WORKGROUP(16, 16)
#line 202
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ_OWN(utextureBuffer, marked, tile_list)
PUSH(float, max_coverage, 0.75, 0.0, 1.0, "1", "chosen by measuring", "the list is used only while at most this fraction of the pixels shows reflections; beyond that it costs more than it saves")
NEEDS_BY(sparse, max_coverage)
DISPATCH(tile_list)
DISPATCH(tile_list)
