/* As resolve/hit: from the picture for screen hits, else from the cube maps. */
PASS("Colour at the hit", "Mafia DE article, Transparency and Glows")
#include "slot.h"
#include "reflection/resolve/sources.h"
