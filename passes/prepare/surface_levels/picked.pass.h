/* The finest level has the pixels that downsample picked; each coarser one picks a texel of the finer one as downsample/mips does. */
PASS("Picked from the finer level", "Mafia DE article, Downscaled Depth and Normals")
#include "slot.h"
#include "../downsample/pick_rows.h"
#line 402
READ_OWN(texture2D, levels, surface_levels)
DISPATCH_LEVELS(surface_levels, 0, 2, down)
DISPATCH_LEVELS(surface_edges, 0, 2, down)
SPEC(bool,  vertex_planes, true, 0, 1, "1", "Mafia DE article, GBuffer Pass", "a texel's plane is given by the vertex normal where the capture has one; off: by the shading normal")
PUSH(float, edge_plane,    0.05, 0.0, 10.0, "1", "glint", "neighbours farther from each other's plane than this fraction of the depth are different surfaces; 10: no test")
PUSH(float, edge_normal,   1.0,  0.0, 4.0,  "1", "glint", "neighbours whose planes differ by more than this, as 1 - cosine, are different surfaces; 4: no test")
