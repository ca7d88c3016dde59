/* Equal or growing steps across the picture, with depth interpolated in 1/z and one correction at the end. */
PASS("Linear march", "KF2 article, Linear ray march; Mafia III talk, Screen-space tracing")
#include "slot.h"
#include "screen_rays/linear_rows.h"
#line 802
SPEC(bool,  sky,         true,  0,   1,     "1", "chosen by measuring", "a ray whose vanishing point shows sky ends there; off: it continues in the cube maps")
PUSH(float, viewer_limit, 1.0, -1.0, 1.0,   "1", "KF2 article, Viewer-facing attenuation", "rays that run towards the viewer, with a cosine to the view vector above this, are not traced; 1: all are traced")
