/* The picture that the pipeline has made so far (picture.glsl). */
#include "composed_rows.h"
#line 612
OPTIONAL_READ(texture2D, unstippled, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, antialiased, RGBA16F, FULL, 0)
