/* A history of half-resolution reflections. */
#line 202
WRITE(image2D, temporal_age, R16F, "samples", HALF, "n", 0, "number of samples averaged in reflection_temporal")
HISTORY(texture2D, previous_reflection, reflection_temporal)
HISTORY(texture2D, previous_age, temporal_age)
HISTORY(texture2D, previous_depth_half, depth_half)
HISTORY(texture2D, previous_normal_half, normal_half)
HISTORY(utexture2D, previous_pick, pick)
PUSH(float, history,       15.0, 0.0, 255.0, "1", "Mafia III talk, Temporal filter", "max weight of the history relative to the new frame; until it is reached, n frames are weighted equally; 0: no history")
PUSH(float, history_depth, 0.02, 0.0, 10.0, "1", "Mafia III talk, Temporal filter", "history farther from the surface's plane than this fraction of the depth is rejected; 10: no test")
PUSH(float, history_normal, 0.9, -1.0, 1.0, "1", "Mafia III talk, Temporal filter", "min cosine between the previous and the current normal; -1: no test")
#include "shared/reuse_rows.h"
#include "shared/reproject_rows.h"
