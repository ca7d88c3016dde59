/* What every variant of this slot reads and writes. */
#line 102
SLOT("The picture with bloom")
#include "this_frame/picture_rows.h"
#line 202
READ(texture2D, bloom_blurred)
NEEDS_MADE(bloom_blurred)
WRITE(image2D, bloomed, RGBA16F, "radiance", FULL, "R G B A", 0, "the picture, with the light that blooms added; a: 1")
DISPATCH(bloomed)
REFERENCE_NONE("bloom is no light of the scene")
