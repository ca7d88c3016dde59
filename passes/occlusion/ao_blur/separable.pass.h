/* Along rows, then along columns; only texels of one surface are mixed. */
PASS("Rows, then columns", "Mafia DE article, SSAO; GTA V article, SSAO")
#include "slot.h"
#line 202
WRITE(image2D, occlusion_across, R16F, "1", HALF, "visibility", 1, "occlusion_half after the blur along rows")
READ_OWN(texture2D, across, occlusion_across)
DISPATCH(occlusion_across)
DISPATCH(occlusion_blurred)
SPEC(int,   radius,      2,    0,   32,   "texels", "chosen by measuring", "radius of the blur; 2 covers the 4 x 4 texels of ao_trace.pattern=grid once; 0: no blur")
CHOICE2(kernel, box, box, gaussian, "glint", "box: all texels count alike, those at the ends by half; gaussian: the nearer ones more, with a standard deviation of half the radius")
PUSH(float, depth_part,  0.02, 0.0, 10.0, "1", "chosen by measuring", "a texel farther from the surface's plane than this fraction of the depth gets no weight; 10: no test")
PUSH(float, normal_part, 0.3,  0.0, 2.0,  "1", "chosen by measuring", "a texel whose normal differs by more than this, as 1 - cosine, gets no weight; 2: no test")
