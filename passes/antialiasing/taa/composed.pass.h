/* Works on the picture that the pipeline composes, with water and transparent surfaces. */
PASS("Of the composed picture", "Mafia DE article, Temporal AA")
#include "slot.h"
#line 202
READ(texture2D, composed)
OPTIONAL_READ(texture2D, composed_water, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_fog, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_transparent, RGBA16F, FULL, 0)
