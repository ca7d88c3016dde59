/* Skips cells of the pyramid that the ray passes in front of; hits are decided as in dda. */
PASS("Pyramid of the nearest depth", "KF2 article, HZB Optimization; Uludag 2014")
#include "slot.h"
#include "cell_rows.h"
#line 402
READ(texture2D, hiz)
READ(texture2D, depth_slopes)
SPEC(int,   cells,       256,   1,   65536, "cells", "KF2 article, HZB Optimization", "max cells visited")
