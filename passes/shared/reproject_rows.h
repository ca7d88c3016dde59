/* How a pixel finds its place in the previous frame; of every pass that has a history. */
#line 302
CHOICE2(reprojection, surface, surface, reflection, "Mafia III talk, Temporal filter; reflection depth is its future work", "where the surface was (by motion vectors, without them by the camera), or where its reflection was seen, as far behind the surface as the ray went")
SPEC(bool, motion, true, 0, 1, "1", "Mafia III talk, Temporal filter", "use motion vectors where the capture has them; off: the camera's alone")
PUSH(float, divergence, 0.25, 0.0, 1e6, "1", "Mafia III talk, Temporal filter; chosen by measuring", "the view may turn by this part of the reflected lobe's angle over the length of the history, which is cut to hold that; 1e6: views do not matter")
