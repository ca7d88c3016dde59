/* One of the four pixels of each texel. */
PASS("One of four pixels", "GTA V article, Water")
#include "slot.h"
#line 202
CHOICE3(choose, nearest, first, nearest, farthest, "left open by the GTA V article; chosen by measuring", "which pixel. first: the upper left one; nearest, farthest: by depth, so that thin objects in front of the bottom count or do not; sky counts only where all are sky")
