/* Points in the hemisphere over the surface are compared with the depth buffer in front of them. */
PASS("Points in the hemisphere", "Mafia DE article, SSAO; GTA V article, SSAO")
#include "slot.h"
#include "points_rows.h"
#line 402
SPEC(int,   samples,   16,   1,   1024, "samples", "chosen by measuring", "points per texel")
CHOICE3(range, smooth, smooth, hard, none, "glint", "what keeps distant foreground from occluding. smooth: an occluder whose depth differs from the receiver's by more than the radius counts less, in proportion; hard: not at all; none: it counts")
PUSH(float, spread,    1.0,  0.0, 8.0,  "1", "chosen by measuring", "a point's distance is the radius times a uniform number to this power; 0: all points lie on the sphere")
PUSH(float, thickness, 1e6,  0.0, 1e6,  "1", "chosen by measuring", "assumed thickness of objects along the view ray, in radii: a point farther behind a surface is not occluded; 1e6: everything is solid")
ASSUMED(thickness)
