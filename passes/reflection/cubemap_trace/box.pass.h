/* No march: the ray ends where it leaves a box around the cube map. */
PASS("Parallax-corrected lookup, box", "000, Existing solutions; S. Lagarde, A. Zanuttini, Local Image-Based Lighting with Parallax-Corrected Cubemaps, 2012")
#include "slot.h"
#include "corrected_rows.h"
