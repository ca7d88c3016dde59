/* How a pixel finds its position in the previous frame. */
#line 302
CHOICE2(reprojection, surface, surface, reflection, "Mafia III talk, Temporal filter; reflection depth is its future work", "which point is reprojected. surface: the surface (with motion vectors, or with the camera if there are none); reflection: the virtual image of the reflection, as far behind the surface as the ray travelled")
SPEC(bool, motion, true, 0, 1, "1", "Mafia III talk, Temporal filter", "use motion vectors where the capture has them; off: the camera's motion only")
PUSH(float, divergence, 0.25, 0.0, 1e6, "1", "Mafia III talk, Temporal filter; chosen by measuring", "max rotation of the view vector over the length of the history, as a fraction of the angle of the reflected lobe; the history is shortened to stay within it; 1e6: no limit")
