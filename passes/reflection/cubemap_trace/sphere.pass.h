/* No march: the ray ends where it leaves a sphere around the cube map's centre. */
PASS("Parallax-corrected lookup, sphere", "Mafia III talk, Existing solutions; Bjorke 2004")
#include "slot.h"
#include "corrected_rows.h"
