/* As resolve/previous: screen hits sample the previous frame, or the cube map nearest to the hit. */
PASS("Colour of the previous frame", "Mafia DE article, Transparency and Glows; Global Illumination")
#include "slot.h"
#include "reflection/resolve/sources.h"
#include "reflection/resolve/before_rows.h"
