/* Cells of the pyramid that a ray lies in front of are crossed at once; what decides is as in dda. */
PASS("Pyramid of the nearest depth", "KF2 article, HZB Optimization; Uludag 2014")
#include "slot.h"
#include "cell_rows.h"
#line 302
READ(texture2D, hiz)
READ(texture2D, depth_slopes)
SPEC(int,   cells,       256,   1,   65536, "cells", "KF2 article, HZB Optimization", "cells looked at, at most")
SPEC(int,   cells_lq,    256,   1,   65536, "cells", "Mafia III talk, Screen-space tracing", "the same on rougher surfaces")
PUSH(float, hq_roughness, 0.1,  0.0, 1.0,   "1", "Mafia III talk, Screen-space tracing", "largest roughness of a smooth surface")
