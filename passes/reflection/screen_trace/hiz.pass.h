/* Skips cells of the pyramid that the ray passes in front of; hits are decided as in dda. */
PASS("Pyramid of the nearest depth", "KF2 article, HZB Optimization; Uludag 2014")
#include "slot.h"
#include "screen_rays/cell_rows.h"
#line 302
READ(texture2D, hiz)
READ(texture2D, depth_slopes)
SPEC(int,   cells,       256,   1,   65536, "cells", "KF2 article, HZB Optimization", "max cells visited on smooth surfaces")
SPEC(int,   cells_lq,    256,   1,   65536, "cells", "Mafia III talk, Screen-space tracing", "max cells visited on rougher surfaces")
PUSH(float, hq_roughness, 0.1,  0.0, 1.0,   "1", "Mafia III talk, Screen-space tracing", "max roughness of a smooth surface")
