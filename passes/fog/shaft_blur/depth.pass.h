/* Along rows, then along columns, then interpolated; only texels at about the same depth are mixed, sky with sky. */
PASS("Rows, columns, up", "GTA V article, light-shaft map")
#include "slot.h"
#line 202
REFERENCE_NONE("the reference has no fog")
WRITE(image2D, shaft_across, R16F, "1", HALF, "lit", 1, "shaft_half after the blur along rows")
WRITE(image2D, shaft_blurred, R16F, "1", HALF, "lit", 1, "shaft_across after the blur along columns")
READ_OWN(texture2D, across, shaft_across)
READ_OWN(texture2D, mixed, shaft_blurred)
DISPATCH(shaft_across)
DISPATCH(shaft_blurred)
DISPATCH(shafts)
SPEC(int,   radius,      2,    0,   32,   "texels", "glint", "radius of the blur, whose texels at the ends count by half; 2 covers the 4 x 4 texels of shaft_march.pattern=bayer once; 0: no blur")
PUSH(float, depth_part,  0.1,  0.0, 10.0, "1", "glint", "texels whose depth differs by more than this fraction are not mixed, unless no other texel lies about a pixel; 10: no test")
