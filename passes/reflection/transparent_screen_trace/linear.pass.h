/* The march of screen_trace/linear. The depth buffer knows nothing of the surface that the ray leaves, which is in front of all. */
PASS("Linear march", "Mafia DE article, Transparency and Glows; KF2 article, Linear ray march")
#include "slot.h"
#include "reflection/screen_trace/linear_rows.h"
