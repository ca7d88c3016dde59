/* Equal or growing steps across the picture, depth interpolated in 1/z, one correction at the end. */
PASS("Linear march", "KF2 article, Linear ray march; Mafia III talk, Screen-space tracing")
#include "slot.h"
#include "linear_rows.h"
#line 802
SPEC(bool,  sky,         true,  0,   1,     "1", "chosen by measuring", "a ray whose vanishing point shows the sky ends there; off: the cube maps decide")
PUSH(float, viewer_limit, 1.0, -1.0, 1.0,   "1", "KF2 article, Viewer-facing attenuation", "rays that close up to the viewer (cosine of the angle to the view vector) are not traced; 1: all are")
