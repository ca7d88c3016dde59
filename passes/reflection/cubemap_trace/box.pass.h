/* No march: the ray ends where it leaves a box around the cube map's centre. */
PASS("Parallax-corrected lookup, box", "Mafia III talk, Existing solutions; Lagarde and Zanuttini 2012")
#include "slot.h"
#include "corrected_rows.h"
