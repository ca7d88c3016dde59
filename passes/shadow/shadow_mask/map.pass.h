/* Compares the surfaces with the engine's shadow map, for captures without a mask. Where there is a mask, too, the darker of both counts. */
PASS("From the shadow map", "Mafia DE article, Parallel Split Shadows")
#include "slot.h"
#line 202
READ(texture2D, shadow_map)
WITHOUT(shadow_map, "the captured mask alone counts")
READ(texture2D, depth_full)
SPEC(int,   taps,      3,   1,   15,  "1", "Mafia DE article, Parallel Split Shadows", "texels compared along each side of a square, whose results are averaged; 1: the nearest texel")
PUSH(float, bias_part, 1.0, 0.0, 64.0, "1", "glint", "factor on the bias that the engine adds to the stored depth; 0: none")
