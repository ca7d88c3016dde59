/* What a hit on screen shows is looked up in the previous frame, where the hit's motion leads; where that point was hidden or
   outside of the picture, in the cube maps. */
PASS("Colour of the previous frame", "Mafia DE article, Global Illumination; Stochastic Sampling")
#include "slot.h"
OPTIONAL_READ(texture2D, cone_half, R16F, HALF, 0)
#include "ends.h"
#include "sources.h"
#include "before_rows.h"
#line 352
DIAGNOSTIC(uimage2D, previous_source, R8UI, "1", HALF, "source", 0, "where a hit on screen found its colour: 1: in the previous frame, 2: its point was outside of the picture or behind the camera, 3: it was hidden; 0: no hit on screen")
ALONG_RAYS(cubemap_color, normal_jittered)
