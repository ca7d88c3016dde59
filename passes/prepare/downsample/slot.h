/* What every variant of this slot reads and writes. */
#line 102
SLOT("G-buffer at the pipeline's resolution, with normals jittered by the NDF")
READ(texture2D, depth_full)
READ(texture2D, normal_full)
WRITE(image2D, inverse_half, R32F, "1/m", HALF, "Z", 0, "1 / depth_half, which is linear on planes; 0 where sky")
WRITE(image2D, depth_half, R32F, "m", HALF, "Z", INFINITY, "view-linear depth of the picked pixel; +inf where sky")
WRITE(image2D, normal_jittered, RGBA16F, "1", HALF, "X Y Z roughness", 0, "normal drawn from the NDF around normal_half, in world space; w: roughness")
WRITE(image2D, normal_half, RGBA16F, "1", HALF, "X Y Z roughness", 0, "unit normal before jittering, in world space; w: roughness")
WRITE(image2D, cone_half, R16F, "rad", HALF, "angle", 0, "half-angle of the cone that the ray represents; 0: a ray")
WRITE(uimage2D, pick, R8UI, "1", HALF, "index", 4, "which pixel of the 2x2 block was picked: x + 2y; 4: the centre of the block; 8 is added when the reflection is not visible in the picture")
DISPATCH(depth_half)
DISPATCH_LIST(tile_list, shown)
PUSH(float, min_weight, 0.0, 0.0, 1.0, "1", "glint", "surfaces that reflect less than this fraction of the radiance towards the viewer trace no rays; 0: all surfaces trace")
NEEDS(reflections)
NEEDED_IF_READ
PER_RAY
#include "shared/shown_rows.h"
ROLE(RAY_NORMAL, normal_half)
ROLE(RAY_PICK, pick)
ROLE(LOBE, ndf)
ROLE(DEFINES_RESULT, ndf)
