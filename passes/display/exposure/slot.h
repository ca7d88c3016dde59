/* What every variant of this slot reads and writes. */
#line 102
SLOT("Exposure of the picture")
#include "this_frame/picture_rows.h"
#line 202
OPTIONAL_READ(texture2D, bloomed, RGBA16F, FULL, 0)
WRITE(image2D, exposed, RGBA16F, "1", FULL, "R G B A", 0, "the picture, scaled so that 1 is what the display shows as white without a tone curve; linear. a: 1")
DISPATCH(exposed)
REFERENCE_NONE("how a picture is displayed is no light of the scene")
