/* The picture, filled with water: the deeper, the more of its own colour. */
PASS("Bottom behind water", "GTA V article, Water")
#include "slot.h"
#line 202
CHOICE3(along, refracted, refracted, view, up, "GTA V article, Water (green channel of the opacity map), which leaves it open; chosen by measuring", "the way through the water that absorbs and scatters. refracted: to the eye, bent at a level surface; view: straight to the eye; up: straight up")
SPEC(bool,  depth,    true,  0, 1, "1", "GTA V article, Water (green channel of the opacity map)", "absorption and scattering depend on the distance through the water; off: every distance is one metre")
PUSH(float, index,    1.333, 1.0, 4.0, "1", "glint", "refractive index, with along=refracted")
PUSH(float, caustics, 1.0,   0.0, 16.0, "1", "GTA V article, Water", "factor on the caustics of the capture; 0: none")
