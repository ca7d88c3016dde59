/* Rays in growing steps across the picture, as in the slot screen_trace. */
PASS("Linear march", "Mafia DE article, Global Illumination")
#include "slot.h"
#include "previous_frame/picture_rows.h"
#include "screen_rays/linear_rows.h"
#line 802
SPEC(bool,  sky,         true,  0,   1,     "1", "chosen by measuring", "a ray whose vanishing point shows sky ends there; off: it misses")
PUSH(float, viewer_limit, 1.0, -1.0, 1.0,   "1", "KF2 article, Viewer-facing attenuation", "rays that run towards the viewer, with a cosine to the view vector above this, are not traced; 1: all are traced")
