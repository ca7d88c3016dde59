/* Rays through the pyramid of the nearest depth, as in the slot screen_trace. */
PASS("Pyramid of the nearest depth", "glint; KF2 article, HZB Optimization")
#include "slot.h"
#include "screen_rays/cell_rows.h"
#include "previous_frame/picture_rows.h"
#line 402
READ(texture2D, hiz)
READ(texture2D, depth_slopes)
SPEC(int,   cells,       256,   1,   65536, "cells", "KF2 article, HZB Optimization", "max cells visited")
