/* Rays through every texel that they cross, as far as the radius. */
PASS("Rays over every texel", "glint; McGuire and Mara 2014")
#include "slot.h"
#line 402
DISPATCH(occlusion_half)
READ(texture2D, inverse_half)
SPEC(int,   directions,  64,    1,   65536, "rays", "glint", "rays per texel")
SPEC(int,   cells,       4096,  1,   65536, "texels", "McGuire and Mara 2014", "max texels that a ray visits")
SPEC(bool,  pass_behind, true,  0,   1,     "1", "glint", "rays continue behind objects; off: they end there, unoccluded")
SPEC(bool,  inside,      true,  0,   1,     "1", "glint", "a ray that would be inside an object (solid) is occluded; off: it is not")
PUSH(float, thickness,   0.01,  0.0, 100.0, "1", "chosen by measuring", "relative thickness: a ray that arrives behind a surface by at most this fraction of the depth hits it")
PUSH(float, thickness_m, 0.0,   0.0, 1e6,   "m", "chosen by the measured error", "absolute thickness, added to the relative one; 1e6: everything is solid")
PUSH(float, seam,        0.5,   0.0, 0.5, "texels", "glint", "a ray that arrives behind a surface hits it if it crossed the surface's plane at most this far before")
PUSH(float, jump,        0.01,  0.0, 1e6,   "1", "glint", "max relative distance between the surfaces of the two texels at such a seam")
PUSH(float, solid,       1.0,   0.0, 1e6,   "1", "chosen by the measured error", "assumed depth of objects, relative to the distance that a ray covers behind them; 0: infinitely thin")
PUSH(float, bias,        0.0001, 0.0, 1.0,  "1", "KF2 article, Banding and Self-Intersection", "min relative depth behind a surface that counts as behind")
ASSUMED(thickness)
ASSUMED(thickness_m)
ASSUMED(solid)
ASSUMED(jump)
REFERENCE
REFERENCE_SET(ao_trace, directions, 1)
