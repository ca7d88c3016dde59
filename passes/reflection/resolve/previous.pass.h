/* Screen hits sample the previous frame, reprojected by the hit's motion; where that point was occluded or outside the
   picture, they sample the cube maps. */
PASS("Colour of the previous frame", "Mafia DE article, Global Illumination; Stochastic Sampling")
#include "slot.h"
OPTIONAL_READ(texture2D, cone_half, R16F, HALF, 0)
OPTIONAL_READ(texture2D, normal_half, RGBA16F, HALF, 0)
#include "ends.h"
#include "sources.h"
#include "before_rows.h"
#line 352
DIAGNOSTIC(uimage2D, previous_source, R8UI, "1", HALF, "source", 0, "source of a screen hit's colour. 1: the previous frame; 2: not in the previous frame: outside its picture or behind its camera; 3: not in the previous frame: occluded there; 0: no screen hit")
ALONG_RAYS(cubemap_color, normal_jittered)
