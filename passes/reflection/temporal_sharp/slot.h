/* What every variant of this slot reads and writes. */
#line 102
SLOT("Temporal filter of the full-resolution reflection")
READ(texture2D, reflection)
OPTIONAL_READ(texture2D, reflection_sharp, RGBA16F, FULL, -1)
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(texture2D, motion_full)
WITHOUT(motion_full, "reprojected with the cameras alone")
READ(texture2D, travelled)
OPTIONAL_READ(utexture2D, pick, R8UI, HALF, 4)
WRITE(image2D, reflection_stable, RGBA16F, "radiance", FULL, "R G B A", -1, "reflection_sharp combined with previous frames on smooth surfaces; a: 0 where no frame found a colour, which is not used as history")
DISPATCH(reflection_stable)
NEEDS(reflecting)
REFERENCE_NONE("a frame of the reference has enough rays of its own")
REFERENCE_WITH(resolve_sharp, "it stabilizes what resolve_sharp computes")
OPTIONAL_READ(texture2D, disocclusion, R16F, FULL, 0)
#include "shared/shown_rows.h"
