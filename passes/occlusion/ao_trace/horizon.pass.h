/* The highest surfaces on either side of slices through the view vector; what lies below them is integrated with the cosine. */
PASS("Horizons with cosine weight", "Jimenez et al. 2016")
#include "slot.h"
#include "points_rows.h"
#line 402
SPEC(int,   slices,    2,    1,   256,  "slices", "chosen by measuring", "slices per texel, each with two sides")
SPEC(int,   steps,     6,    1,   1024, "steps", "chosen by measuring", "points on either side of a slice")
CHOICE3(averaged, difference, difference, ratio, visible, "glint; Jimenez et al. 2016", "what is averaged. difference: 1 less the occluded part, so that a texel without occluders is exactly 1; ratio: occluded part of what the chosen slices contain, which is less noisy, but not exact on average; visible: the visible part, as in the paper")
CHOICE3(behind, sectors, solid, decay, sectors, "Jimenez et al. 2016; Therrien et al. 2023", "what lies behind the surface at a point. solid: everything below the horizon is occluded; decay: the horizon sinks by the fraction `decay` towards each lower point behind it; sectors: each point hides the angle up to its assumed thickness, in 32 sectors a side")
PUSH(float, growth,    1.4,  0.5, 8.0,  "1", "chosen by measuring", "point i of n lies at (i/n)^growth of the radius on screen; 1: equal steps")
PUSH(float, fade,      0.0,  0.0, 1.0,  "1", "Jimenez et al. 2016", "fraction of the radius over which occluders fade out; 0: they count fully up to the radius. Not for behind=sectors")
PUSH(float, decay,     0.1,  0.0, 1.0,  "1", "Jimenez et al. 2016", "with behind=decay: how much of the height of a horizon a lower point behind it takes away; 0: none")
PUSH(float, thickness, 1.0,  0.0, 1e6,  "1", "chosen by measuring", "with behind=sectors: assumed thickness of objects along the view ray, in radii; 1e6: everything is solid")
ASSUMED(thickness)
ASSUMED(decay)
