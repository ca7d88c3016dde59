/* The fog that the capture's attributes describe, in closed form. */
PASS("Height fog", "GTA V article, Atmosphere; Mafia DE article, Volumetric Fog")
#include "slot.h"
#line 202
SPEC(bool,  sky,       false, 0, 1, "1", "GTA V article, Atmosphere", "fog covers the sky, too; off: the sky is as the engine drew it, after the fog")
SPEC(bool,  froxels,   true, 0, 1, "1", "Mafia DE article, Volumetric Fog", "light that lamps and the sun send into the air is added, where the capture has it in slices: blurred, if a pass of the pipeline does that; off: the fog has its own colour alone")
CHOICE2(froxel_filter, bilinear, nearest, bilinear, "glint", "how its cells are looked up within a slice. nearest: the one that the pixel lies in; bilinear: the four around it, without those that froxel_blur finds hidden")
PUSH(float, sun_share, 0.5, 0.0, 1.0, "1", "glint", "part of the fog's colour that is sunlight, which is missing where shafts say that the air is shaded; 0: shafts have no effect")
PUSH(float, intensity, 1.0, 0.0, 16.0, "1", "glint", "factor on the fog's density; 0: no fog")
ASSUMED(sun_share)
