/* Two paraboloids per cube map: a third of the texels, and no seams when filtered. */
PASS("Dual paraboloids", "GTA V article, Cubemap to Dual-Paraboloid Map")
#include "slot.h"
#line 202
READ_OWN(texture2DArray, finer, paraboloids)
SPEC(int,   taps,        2,    1, 4, "1", "glint", "lookups along each axis per texel; a texel at the pole covers four texels of the cube map")
SPEC(bool,  fill,        true, 0, 1, "1", "glint; the article says nothing", "texels outside the disc hold the directions beyond the rim, so that filtering at the rim is continuous; off: they are black")
SPEC(bool,  solid_angle, true, 0, 1, "1", "glint", "coarser levels weight texels by solid angle; off: all weights are equal")
DISPATCH_LEVELS(paraboloids, 0, -1, down)
