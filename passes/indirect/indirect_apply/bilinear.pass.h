/* Interpolates the four nearest texels, ignoring depth and normal. */
PASS("Bilinear", "glint (the baseline)")
#include "slot.h"
REFERENCE
