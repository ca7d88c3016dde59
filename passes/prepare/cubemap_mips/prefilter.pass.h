/* Chains whose colour levels are filtered with the lobe of the cone that each represents. */
PASS("Pre-filtered for cones", "Mafia III talk, Pre-filtering cube-maps")
#include "slot.h"
#line 202
WRITE(image2DArray, cubemap_color_box, RGBA16F, "radiance", CUBEMAPS_MIPS, "R G B A", 0, "the box-filtered chain that is the input of the pre-filter")
READ_OWN(textureCubeArray, finer_color, cubemap_color_box)
READ_OWN(texture2DArray, finer_faces, cubemap_color_box)
READ_OWN(texture2DArray, finer_distance, cubemap_distance_mips)
#include "shared/join_rows.h"
#include "shared/prefilter_rows.h"
DISPATCH_LEVELS(cubemap_color_box, 0, -1, down)
DISPATCH_LEVELS(cubemap_color_mips, 0, -1, down)
