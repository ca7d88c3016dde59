/* The march of screen_trace/linear. The depth buffer knows nothing of the surface that the ray leaves, which is in front of all. */
PASS("Linear march", "001, Transparency and Glows; 002, Linear ray march")
#include "slot.h"
#include "reflection/screen_trace/linear_rows.h"
