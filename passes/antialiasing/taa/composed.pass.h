/* Works on the picture that the pipeline composes, with water and transparent surfaces. */
PASS("Of the composed picture", "Mafia DE article, Temporal AA")
#include "slot.h"
#line 202
OPTIONAL_READ(texture2D, unstippled, RGBA16F, FULL, 0)
#include "this_frame/composed_rows.h"
