/* Steps across the picture, each of which tests the texel that it lands on: finer steps skip fewer texels, and with none
   skipped the rays end as in dda. */
PASS("Linear march over facets", "KF2 article, Linear ray march; hits are decided as in dda")
#include "slot.h"
#include "screen_rays/cell_rows.h"
#line 302
SPEC(int,   steps,       32,    1,   4096, "samples", "KF2 article, Linear ray march", "samples along the ray; several in one texel count as one step")
SPEC(int,   refinements, 4,     0,   32,    "halvings", "KF2 article, Binary Search", "bisections of a step in which the ray went behind a surface that it did not cross; 0: none")
SPEC(bool,  dither,      true,  0,   1,     "1", "KF2 article, Dithering", "shift the samples of each ray by a random part of a step")
PUSH(float, growth,      1.5,   0.5, 8.0,   "1", "chosen by measuring", "sample i of n lies at (i/n)^growth of the ray's length on screen; 1: equal steps")
PUSH(float, first_step,  0.0,   0.0, 1.0,   "1", "glint", "fraction of the ray's length that the first step takes, from which the growth then follows; 0: use growth")
