/* The four nearest texels, those of them that edges do not part from the pixel's own surface. */
PASS("Bilinear up to edges", "Mafia DE article, Downscaled Depth and Normals")
#include "slot.h"
DISPATCH(reflection)
DISPATCH_TILES(shown)
#line 202
READ(utexture2D, edge_levels)
SPEC(bool,  lobes,      true, 0,   1,    "1", "glint", "a texel counts by how far its lobe is the pixel's; off: the pixel's normal and roughness do not matter")
SPEC(bool,  edges,      true, 0,   1,    "1", "Mafia DE article, Downscaled Depth and Normals", "leave out what is beyond an edge from the texel that is most like the pixel; off: edges are not looked at")
PUSH(float, depth_part, 0.02, 0.0, 10.0, "1", "glint", "a texel farther than this part of the depth from the pixel's plane weighs next to nothing; 10: no such test")
PUSH(float, roughness_part, 0.1, 0.0, 1.0, "1", "glint", "lobes whose roughness differs by more do not agree")
