/* One colour at the end of each ray: the diffuse picture for screen hits, the cube maps for the others. */
PASS("Colour at the hit", "000, Color resolve shaders")
#include "slot.h"
SPEC(bool,  fog,         true,  0, 1, "1", "000, Color resolve shaders", "fade the reflection with the fog between surface and hit")
SPEC(bool,  filter_color, true, 0, 1, "1", "glint", "bilinear lookups; off: the nearest texel")
SPEC(bool,  check_depth, false, 0, 1, "1", "glint; the slides just fetch", "a screen hit counts only where the picture's depth agrees with the ray's end")
CHOICE2(fog_target, sky, color, sky, "000, Color resolve shaders", "fade towards the sky along the ray, or towards the fog's own colour; a capture without a sky takes the colour")
PUSH(float, depth_tolerance, 0.05, 0.0, 10.0, "1", "glint", "relative depth difference that check_depth accepts")
