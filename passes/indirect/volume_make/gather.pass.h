/* Every cell adds up what the nearest cube map that sees it shows, each texel of it as a patch of a surface at its distance. */
PASS("Gathered from cube maps", "Mafia DE article, GI Update")
#include "slot.h"
#line 202
REFERENCE
SPEC(int,   taps,   6,    1,   64,   "texels", "glint", "texels that are taken along each side of a cube map's face")
SPEC(bool,  moved,  true, 0,   1,    "1", "glint", "what the cube map shows lies at its distances: its direction and its solid angle are those that the cell sees; off: as from the cube map's centre")
PUSH(float, cell_m, 1.0,  0.01, 100.0, "m", "glint", "width of a cell: 24 cells each way lie around the camera")
PUSH(float, tolerance, 0.5, 0.0, 100.0, "cells", "glint", "a cell still counts as seen by a cube map when its middle is so far behind the surface that the map shows; 100: all are seen")
