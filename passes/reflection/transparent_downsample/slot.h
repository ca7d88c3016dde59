/* What every variant of this slot reads and writes. */
#line 102
SLOT("The nearest transparent surface at the pipeline's resolution")
READ(texture2D, transparent_color)
READ(texture2D, transparent_normal)
READ(texture2D, transparent_depth)
WRITE(image2D, transparent_depth_half, R32F, "m", HALF, "Z", INFINITY, "view-linear depth of the picked pixel's surface; +inf where there is none")
WRITE(image2D, transparent_normal_jittered, RGBA16F, "1", HALF, "X Y Z roughness", 0, "normal that leads to its ray, world axes; w: roughness")
WRITE(image2D, transparent_cone, R16F, "rad", HALF, "angle", 0, "half-angle of the cone that the ray stands for; 0: a ray")
WRITE(uimage2D, transparent_pick, R8UI, "1", HALF, "index", 0, "which pixel of the 2x2 block was taken: x + 2y")
DISPATCH(transparent_depth_half)
DISPATCH_TILES(shown)
#include "shared/transparent_tile_rows.h"
NEEDS(transparent)
PER_RAY
REFERENCE_NONE("laid over the picture: no part of the reflection that a reference is of")
