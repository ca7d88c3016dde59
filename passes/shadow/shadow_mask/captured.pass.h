/* The mask that the engine resolved from its shadow maps. */
PASS("The captured mask", "Mafia DE article, Parallel Split Shadows")
#include "slot.h"
#line 202
WITHOUT(sun_mask, "contact shadows are all that shades the sun")
