/* Two paraboloids for each cube map: a third of the texels, filtered without seams. */
PASS("Dual paraboloids", "GTA V article, Cubemap to Dual-Paraboloid Map")
#include "slot.h"
#line 202
SELF(texture2DArray, finer, paraboloids)
SPEC(int,   taps,        2,    1, 4, "1", "glint", "lookups along each axis that make a texel; one at the pole covers four of the cube map's")
SPEC(bool,  fill,        true, 0, 1, "1", "glint; the article says nothing", "texels outside the disc hold what lies beyond the rim, before filtering; off: black")
SPEC(bool,  solid_angle, true, 0, 1, "1", "glint", "coarser levels weigh texels by their solid angle; off: evenly")
DISPATCH_LEVELS(paraboloids, 0, -1, down)
