/* What every variant of this slot reads and writes. */
#line 102
SLOT("Smoothing of stippled surfaces")
#include "this_frame/composed_rows.h"
#line 202
READ(texture2D, stipple_mask)
WRITE(image2D, unstippled, RGBA16F, "radiance", FULL, "R G B A", 0, "the composed picture, with water and transparent surfaces, in which stippled surfaces are mixed with what shows between them; a as in that picture")
DISPATCH(unstippled)
NEEDS(stippled)
REFERENCE_NONE("it works on the finished picture, which the reference does not compute")
