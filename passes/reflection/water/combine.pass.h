/* Combines what is behind the water with what it reflects. */
PASS("Refraction and reflection combined", "GTA V article, Water")
#include "slot.h"
#include "surface_rows.h"
#line 202
SPEC(bool,  depth,      true, 0, 1, "1", "GTA V article, Water (green channel of the opacity map)", "absorption and scattering depend on the distance through the water; off: every distance is one metre")
