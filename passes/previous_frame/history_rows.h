/* A history at the pipeline's resolution: the surfaces that it showed, and when it is valid. */
#line 222
HISTORY(texture2D, previous_depth_half, depth_half)
HISTORY(texture2D, previous_normal_half, normal_half)
HISTORY(utexture2D, previous_pick, pick)
PUSH(float, history,       15.0, 0.0, 255.0, "1", "Mafia III talk, Temporal filter", "max weight of the history relative to the new frame; until it is reached, n frames are weighted equally; 0: no history")
PUSH(float, history_depth, 0.02, 0.0, 10.0, "1", "Mafia III talk, Temporal filter", "history farther from the surface's plane than this fraction of the depth is rejected; 10: no test")
PUSH(float, history_normal, 0.9, -1.0, 1.0, "1", "Mafia III talk, Temporal filter", "min cosine between the previous and the current normal; -1: no test")
