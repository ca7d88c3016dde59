/* A factor that does not depend on the picture. */
PASS("By stops", "Mafia DE article, Post-Processing")
#include "slot.h"
#line 302
SPEC(bool,  captured, true, 0,   1,  "1",     "glint", "multiply by the exposure that the capture states; off: by 1")
PUSH(float, stops,    0.0, -32.0, 32.0, "stops", "Mafia DE article, Post-Processing, which has no value", "exposure correction: each stop doubles the picture; 0: none")
