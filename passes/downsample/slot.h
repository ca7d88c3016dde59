/* What every variant of this slot reads and writes. */
#line 102
SLOT("G-buffer at the pipeline's resolution, normals jittered by the NDF")
READ(texture2D, depth_full)
READ(texture2D, normal_full)
WRITE(image2D, inverse_half, R32F, "1/m", HALF, "Z", 0, "1 / depth_half, which is linear on planes; 0 where sky")
WRITE(image2D, depth_half, R32F, "m", HALF, "Z", INFINITY, "view-linear depth of the picked pixel; +inf where sky")
WRITE(image2D, normal_jittered, RGBA16F, "1", HALF, "X Y Z roughness", 0, "normal drawn from the NDF around normal_half, world axes; w: roughness")
WRITE(image2D, normal_half, RGBA16F, "1", HALF, "X Y Z roughness", 0, "unit normal as it was, world axes; w: roughness")
WRITE(image2D, cone_half, R16F, "rad", HALF, "angle", 0, "half-angle of the cone that the ray stands for; 0: a ray")
WRITE(uimage2D, pick, R8UI, "1", HALF, "index", 4, "which pixel of the 2x2 block was taken: x + 2y; 4: the block's centre; + 8 when the picture does not show its reflection")
DISPATCH(depth_half)
DISPATCH_TILES(shown)
#include "shared/tile_rows.h"
PUSH(float, least_weight, 0.0, 0.0, 1.0, "1", "glint", "surfaces that send less than this share of a reflection to the viewer trace no ray of their own; 0: all do")
NEEDS(reflections)
PER_RAY
#include "shared/shown_rows.h"
ROLE(RAY_NORMAL, normal_half)
ROLE(RAY_PICK, pick)
ROLE(LOBE, ndf)
ROLE(QUESTION, ndf)
