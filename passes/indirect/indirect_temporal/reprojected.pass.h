/* A running mean for as long as the surface was visible, as in the slot temporal. */
PASS("History", "Mafia DE article, Global Illumination; Mafia III talk, Temporal filter")
#include "slot.h"
#line 202
WRITE(image2D, indirect_age, R16F, "samples", HALF, "n", 0, "number of frames averaged in indirect_temporal")
HISTORY(texture2D, previous_color, indirect_temporal)
HISTORY(texture2D, previous_age, indirect_age)
#include "previous_frame/history_rows.h"
#line 302
SPEC(bool, motion, true, 0, 1, "1", "Mafia III talk, Temporal filter", "use motion vectors where the capture has them; off: the camera's motion only")
