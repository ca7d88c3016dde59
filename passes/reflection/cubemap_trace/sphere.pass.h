/* No march: the ray ends where it leaves a sphere around the cube map. */
PASS("Parallax-corrected lookup, sphere", "000, Existing solutions; K. Bjorke, Image-Based Lighting, GPU Gems, 2004")
#include "slot.h"
#include "corrected_rows.h"
