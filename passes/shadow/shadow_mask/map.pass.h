/* Compares the surfaces with the engine's shadow maps of the sun where the capture has no mask; a captured mask is taken as it is. Each surface is
   compared with the first map that holds it, which is the finest cascade, and with the maps that are of its stencil class alone. */
PASS("From the shadow maps", "Mafia DE article, Parallel Split Shadows")
#include "slot.h"
#line 202
READ(texture2D, shadow_map)
WITHOUT(sun_mask, "the shadow maps, if there are any, make the mask")
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(utexture2D, stencil_full)
REFERENCE
SPEC(int,   taps,      1,   1,   15,  "1", "chosen by the measured error", "texels compared along each side of a square, whose results are averaged, in the finest cascade; 1: the nearest texel")
SPEC(int,   far_taps,  1,   1,   15,  "1", "Mafia DE article, Parallel Split Shadows", "the same in the other cascades")
PUSH(float, dither,    0.0, 0.0, 64.0, "texels", "GTA V article, Shadows", "the square is shifted by a pattern of 4 x 4 pixels, over so many texels of the map; 0: not")
PUSH(float, offset,    1.0, 0.0, 64.0, "texels", "glint", "surfaces are compared this many texels of the map above themselves, so that steep ones do not shade themselves; 0: where they are")
PUSH(float, bias_part, 1.0, 0.0, 64.0, "1", "glint", "factor on the bias that the engine adds to the stored depth; 0: none")
