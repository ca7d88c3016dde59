/* Compares the surfaces with the engine's shadow map where the capture has no mask; a captured mask is taken as it is. */
PASS("From the shadow map", "Mafia DE article, Parallel Split Shadows")
#include "slot.h"
#line 202
READ(texture2D, shadow_map)
WITHOUT(sun_mask, "the shadow map, if there is one, makes the mask")
READ(texture2D, depth_full)
READ(texture2D, normal_full)
REFERENCE
SPEC(int,   taps,      1,   1,   15,  "1", "chosen by the measured error", "texels compared along each side of a square, whose results are averaged; 1: the nearest texel")
PUSH(float, offset,    1.0, 0.0, 64.0, "texels", "glint", "surfaces are compared this many texels of the map above themselves, so that steep ones do not shade themselves; 0: where they are")
PUSH(float, bias_part, 1.0, 0.0, 64.0, "1", "glint", "factor on the bias that the engine adds to the stored depth; 0: none")
