/* As resolve/previous: a hit on screen is looked up in the previous frame, or in the cube map nearest to it. */
PASS("Colour of the previous frame", "Mafia DE article, Transparency and Glows; Global Illumination")
#include "slot.h"
#include "reflection/resolve/sources.h"
#include "reflection/resolve/before_rows.h"
