/* Visits every texel that a ray crosses, one after the other: nothing is skipped. */
PASS("DDA over every texel", "glint; McGuire and Mara 2014")
#include "slot.h"
#include "cell_rows.h"
#line 402
SPEC(int,   cells,       4096,  1,   65536, "texels", "McGuire and Mara 2014", "max texels visited")
REFERENCE
REFERENCE_SET(contact_trace, disc, 1)
