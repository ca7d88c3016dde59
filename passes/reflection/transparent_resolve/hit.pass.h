/* As resolve/hit: the picture for screen hits, the cube maps for the others. */
PASS("Colour at the hit", "Mafia DE article, Transparency and Glows")
#include "slot.h"
#include "reflection/resolve/sources.h"
