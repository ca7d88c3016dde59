/* Rays through every texel that they cross, as in the slot screen_trace. */
PASS("DDA over every texel", "glint; McGuire and Mara 2014")
#include "slot.h"
#include "screen_rays/cell_rows.h"
#include "previous_frame/picture_rows.h"
#line 402
SPEC(int,   cells,       4096,  1,   65536, "texels", "McGuire and Mara 2014", "max texels visited")
REFERENCE
REFERENCE_SET(indirect_trace, level, 0)
REFERENCE_SET(indirect_trace, directions, 1)
REFERENCE_SET(indirect_trace, pattern, sobol)
