/* A running mean as long as the surface was seen and the view did not turn too far for its roughness. */
PASS("History for rough surfaces", "000, Temporal filter")
#include "slot.h"
#line 202
WRITE(image2D, temporal_age, R16F, "samples", HALF, "n", 0, "how many samples of a pixel's kind are in reflection_temporal")
HISTORY(texture2D, previous_reflection, reflection_temporal)
HISTORY(texture2D, previous_age, temporal_age)
HISTORY(texture2D, previous_depth_half, depth_half)
HISTORY(texture2D, previous_normal_half, normal_half)
HISTORY(utexture2D, previous_pick, pick)
SPEC(bool,  extra,         true, 0,   1,    "1", "000, Temporal filter", "where there is no history, four more samples at the centres of the neighbouring pluses; off: the pixel's own")
SPEC(bool,  brdf,          true, 0,   1,    "1", "000, Neighbor sample reuse", "weigh those by the lobe's value at their normals; off: all that are no discontinuity alike")
PUSH(float, history,       15.0, 0.0, 255.0, "1", "000, Temporal filter", "largest ratio of history to the new frame; before that, each of n frames has a weight of 1/n; 0: no history")
PUSH(float, history_depth, 0.02, 0.0, 10.0, "1", "000, Temporal filter", "history farther than this part of the depth from the surface's plane was of something else; 10: no such test")
PUSH(float, history_normal, 0.9, -1.0, 1.0, "1", "000, Temporal filter", "smallest cosine between the normals of then and now; -1: no such test")
#include "shared/reuse_rows.h"
#include "shared/reproject_rows.h"
