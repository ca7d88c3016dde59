/* Interpolates those of the four nearest texels that no edge separates from the pixel's surface. */
PASS("Bilinear up to edges", "Mafia DE article, Downscaled Depth and Normals")
#include "slot.h"
DISPATCH(reflection)
DISPATCH_LIST(tile_list, shown)
#line 202
READ(utexture2D, edge_levels)
SPEC(bool,  lobes,      true, 0,   1,    "1", "glint", "weight texels by the agreement of their lobe with the pixel's; off: ignore normal and roughness")
SPEC(bool,  edges,      true, 0,   1,    "1", "Mafia DE article, Downscaled Depth and Normals", "exclude texels beyond an edge from the best matching texel; off: ignore edges")
PUSH(float, depth_part, 0.02, 0.0, 10.0, "1", "glint", "a texel farther from the pixel's plane than this fraction of the depth gets almost no weight; 10: no test")
PUSH(float, roughness_part, 0.1, 0.0, 1.0, "1", "glint", "lobes whose roughness differs by more than this do not agree")
