/* The fog that the capture's attributes describe, in closed form. */
PASS("Height fog", "GTA V article, Atmosphere; Mafia DE article, Volumetric Fog")
#include "slot.h"
#line 202
SPEC(bool,  sky,       false, 0, 1, "1", "GTA V article, Atmosphere", "fog covers the sky, too; off: the sky is as the engine drew it, after the fog")
PUSH(float, sun_share, 0.5, 0.0, 1.0, "1", "glint", "part of the fog's colour that is sunlight, which is missing where shafts say that the air is shaded; 0: shafts have no effect")
PUSH(float, intensity, 1.0, 0.0, 16.0, "1", "glint", "factor on the fog's density; 0: no fog")
ASSUMED(sun_share)
