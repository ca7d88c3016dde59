/* What every variant of this slot reads and writes. */
#line 102
SLOT("The picture as a display shows it")
#include "this_frame/picture_rows.h"
#line 202
OPTIONAL_READ(texture2D, bloomed, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, exposed, RGBA16F, FULL, 0)
READ(texture2D, color_table)
READ(texture2D, lens_dirt)
WRITE(image2D, toned, RGBA16F, "1", FULL, "R G B A", 0, "the picture after lens, tone curve and table of colours; a: 1")
READ_OWN(texture2D, before, toned)
WRITE(image2D, graded, RGBA16F, "1", FULL, "R G B A", 0, "the finished picture; a: 1")
ENCODED_BY(toned, encoding)
ENCODED_BY(graded, encoding)
CHOICE2(encoding, srgb, linear, srgb, "IEC 61966-2-1", "how the picture is stored. srgb: by the curve of sRGB, limited to what a display shows; linear: as it is")
DISPATCH(toned)
DISPATCH(graded)
REFERENCE_NONE("how a picture is displayed is no light of the scene")
