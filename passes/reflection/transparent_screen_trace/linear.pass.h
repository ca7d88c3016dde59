/* The march of screen_trace/linear. The surface that the ray leaves is not in the depth buffer, and in front of all that is. */
PASS("Linear march", "Mafia DE article, Transparency and Glows; KF2 article, Linear ray march")
#include "slot.h"
#include "screen_rays/linear_rows.h"
