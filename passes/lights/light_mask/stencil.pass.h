/* As a stencil buffer that is filled for several lights at once. */
PASS("A bit for each light", "Mafia DE article, Direct Illumination")
#include "slot.h"
#line 202
PUSH(float, share, 0.02, 0.0, 2.0, "1", "Mafia DE article, Direct Illumination (not printed)", "lights whose rectangle covers at least this part of the screen have a mask, smaller ones the rectangle alone; 0: all have one; more than 1: none has")
