/* Filters the sky as cubemap_mips/prefilter filters the cube maps. */
PASS("Pre-filtered for cones", "Mafia III talk, Pre-filtering cube-maps")
#include "slot.h"
#line 202
WRITE(image2DArray, sky_box, RGBA16F, "radiance", SKY_MIPS, "R G B A", 0, "the box-filtered chain that is the input of the pre-filter")
READ_OWN(textureCubeArray, finer_color, sky_box)
READ_OWN(texture2DArray, finer_faces, sky_box)
#include "shared/prefilter_rows.h"
DISPATCH_LEVELS(sky_box, 0, -1, down)
DISPATCH_LEVELS(sky_mips, 0, -1, down)
