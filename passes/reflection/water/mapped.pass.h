/* Combines the refraction map with what the water reflects. */
PASS("Refraction map and reflection combined", "GTA V article, Water")
#include "slot.h"
#include "surface_rows.h"
#line 202
READ(texture2D, refraction_map)
READ(texture2D, linear_depth_half)
