/* How normals are jittered; of every variant of this slot that does it. */
#line 202
SPEC(bool,  jitter,     true, 0, 1, "1", "Mafia III talk, G-buffer down-sampling", "draw the normal from the NDF; off: mirror rays")
CHOICE2(ndf, ggx, blinn_phong, ggx, "Mafia III talk, Modified NDF; GGX is its future work", "distribution that jitters the normal: blinn_phong by half-vector density, ggx by visible normals")
CHOICE2(lobe, half_vector, half_vector, reflection, "Mafia DE article, Stochastic Sampling", "what is drawn: the normal, so that the lobe is the surface's, or the ray itself, by the lobe of a view along the normal, turned around the mirror direction")
CHOICE4(pattern, plus, plus, white, blue, sobol, "Mafia III talk, Modified NDF; blue noise is an idea of theirs", "order of the random numbers: plus gives each of five neighbours a fifth of the azimuth, blue spreads both numbers over neighbours and frames, white is independent, sobol spreads those of a pixel's rays")
CHOICE2(split, solid_angle, cut, solid_angle, "glint; Mafia III talk, Modified NDF", "how rays and pre-filtering share a lobe. solid_angle: rays are drawn from all of it, and the cone of each spans a part of what one ray stands for, which is the inverse of its density; cut: the slides', rays of the middle of the lobe, and one cone for what lies beyond")
SPEC(bool,  shuffle,    true, 0, 1, "1", "Mafia III talk, Modified NDF", "the pattern changes in each frame; off: a pixel keeps its fifth of the azimuth")
SPEC(bool,  horizon,    true, 0, 1, "1", "glint", "a cone is no wider than its ray is above the surface; off: it may look through the surface")
SPEC(int,   tries,      16,   1, 64, "draws", "chosen by measuring", "normals drawn until the ray leaves the surface; then the normal itself is taken")
PUSH(float, share,      1.0,  0.0, 1.0, "1", "Mafia III talk, Importance sampling vs. pre-filtering", "part of the lobe's angle that is left to rays; the rest is left to pre-filtering. 1: no cones")
PUSH(float, threshold,  0.1,  0.001, 0.999, "1", "Mafia III talk, Combining importance sampling with pre-filtering", "lobe value below which split=cut ignores directions when share < 1")
PUSH(float, cone_factor, 1.0, 0.0, 8.0, "1", "chosen by the measured error", "times the cone; 0: rays without a cone")
