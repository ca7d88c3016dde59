/* How a colour is found in the previous frame, and what replaces it. */
#include "previous_frame/picture_rows.h"
#line 332
CHOICE2(hidden, cubemap, black, cubemap, "left open by the Mafia DE article", "colour of a hit that the previous frame does not show: the nearest cube map, sampled at the hit, or black")
