/* Equal or growing steps across the picture, with depth interpolated in 1/z. */
PASS("Linear march", "Mafia DE article, Contact Shadows; KF2 article, Linear ray march")
#include "slot.h"
#line 302
READ(texture2D, inverse_half)
SPEC(int,   steps,       16,    1,   1024,  "samples", "chosen by the measured error", "samples along the ray")
SPEC(bool,  dither,      true,  0,   1,     "1", "KF2 article, Dithering", "shift the samples of each ray by a random part of a step")
SPEC(bool,  interpolate, true,  0,   1,     "1", "glint", "interpolate 1/z between texels, exact on planes; off: the nearest texel")
SPEC(bool,  refine,      false, 0,   1,     "1", "Mafia III talk, Secant refine", "intersect the surface within the last step; off: the sample behind the surface is the hit")
SPEC(bool,  verify,      false, 0,   1,     "1", "chosen by the measured error", "check that the surface is at the refined hit; off: every step that goes behind a surface is a hit")
SPEC(bool,  back_faces,  false, 0,   1,     "1", "KF2 article, Back-face attenuation", "reject hits on back faces; off: they count, since what turns its back to the surface hides the sun, too")
SPEC(bool,  pass_behind, true,  0,   1,     "1", "chosen by the measured error", "continue behind objects; off: the ray ends there and reaches the sun")
PUSH(float, growth,      1.0,   0.5, 8.0,   "1", "chosen by the measured error", "sample i of n lies at (i/n)^growth of the ray's length on screen; 1: equal steps")
PUSH(float, first_step,  0.0,   0.0, 1.0,   "1", "glint", "fraction of the ray's length that the first step takes, from which the growth then follows; 0: use growth")
PUSH(float, thickness,   0.02,  0.0, 100.0, "1", "chosen by the measured error", "relative thickness: a ray behind a surface by more than this fraction of the depth misses it")
PUSH(float, thickness_m, 0.0,   0.0, 1e6,   "m", "chosen by the measured error", "absolute thickness, added to the relative one; 1e6: everything is solid")
PUSH(float, bias,        0.002, 0.0, 1.0,   "1", "KF2 article, Linear ray march", "min relative depth behind a surface that counts as behind")
ASSUMED(thickness)
ASSUMED(thickness_m)
