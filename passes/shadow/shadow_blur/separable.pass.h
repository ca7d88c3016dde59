/* Along rows, then along columns; only pixels of one surface are mixed. Pixels that shadow_early knows to be lit are left as they are. */
PASS("Rows, then columns", "GTA V article, Shadows: depth-aware blur")
#include "slot.h"
#line 202
WRITE(image2D, shadow_across, R16F, "1", FULL, "visibility", 1, "shadow_mask after the blur along rows")
READ_OWN(texture2D, across, shadow_across)
DISPATCH(shadow_across)
DISPATCH(shadow_soft)
SPEC(int,   radius,      2,    0,   32,   "px", "chosen by measuring", "radius of the blur; 0: no blur. shadow_early is used up to 8, in pipelines that trace every pixel up to 4")
CHOICE2(kernel, gaussian, box, gaussian, "glint", "box: all pixels count alike, those at the ends by half; gaussian: the nearer ones more, with a standard deviation of half the radius")
PUSH(float, depth_part,  0.02, 0.0, 10.0, "1", "chosen by measuring", "a pixel farther from the surface's plane than this fraction of the depth gets no weight; 10: no test")
PUSH(float, normal_part, 0.3,  0.0, 2.0,  "1", "chosen by measuring", "a pixel whose normal differs by more than this, as 1 - cosine, gets no weight; 2: no test")
