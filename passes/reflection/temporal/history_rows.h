/* A history of half-resolution reflections; of every variant of this slot. */
#line 202
WRITE(image2D, temporal_age, R16F, "samples", HALF, "n", 0, "how many samples of a pixel's kind are in reflection_temporal")
HISTORY(texture2D, previous_reflection, reflection_temporal)
HISTORY(texture2D, previous_age, temporal_age)
HISTORY(texture2D, previous_depth_half, depth_half)
HISTORY(texture2D, previous_normal_half, normal_half)
HISTORY(utexture2D, previous_pick, pick)
PUSH(float, history,       15.0, 0.0, 255.0, "1", "Mafia III talk, Temporal filter", "largest ratio of history to the new frame; before that, each of n frames has a weight of 1/n; 0: no history")
PUSH(float, history_depth, 0.02, 0.0, 10.0, "1", "Mafia III talk, Temporal filter", "history farther than this part of the depth from the surface's plane was of something else; 10: no such test")
PUSH(float, history_normal, 0.9, -1.0, 1.0, "1", "Mafia III talk, Temporal filter", "smallest cosine between the normals of then and now; -1: no such test")
#include "shared/reuse_rows.h"
#include "shared/reproject_rows.h"
