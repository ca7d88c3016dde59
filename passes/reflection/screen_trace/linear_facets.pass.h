/* Steps across the picture, each of which asks the texel that it comes to: the finer they are, the fewer texels are left
   out, and with none left out the rays end as in dda. */
PASS("Linear march over facets", "KF2 article, Linear ray march; what decides is as in dda")
#include "slot.h"
#include "cell_rows.h"
#line 302
SPEC(int,   steps,       32,    1,   4096, "samples", "KF2 article, Linear ray march", "samples along the ray; several in one texel count as one")
SPEC(int,   refinements, 4,     0,   32,    "halvings", "KF2 article, Binary Search", "times the step in which a ray went behind a surface that it did not meet is halved; 0: none")
SPEC(bool,  dither,      true,  0,   1,     "1", "KF2 article, Dithering", "shift the samples of each ray by a random part of a step")
PUSH(float, growth,      1.5,   0.5, 8.0,   "1", "chosen by measuring", "sample i of n lies at (i/n)^growth of the way; 1: equal steps")
PUSH(float, first_step,  0.0,   0.0, 1.0,   "1", "glint", "part of the way that the first step takes; the growth then follows from it and the number of steps; 0: growth")
