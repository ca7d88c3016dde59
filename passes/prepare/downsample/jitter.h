/* How normals are jittered. */
#line 202
SPEC(bool,  jitter,     true, 0, 1, "1", "Mafia III talk, G-buffer down-sampling", "draw the normal from the NDF; off: rays are mirror rays")
CHOICE2(ndf, ggx, blinn_phong, ggx, "Mafia III talk, Modified NDF; GGX is its future work", "distribution that jitters the normal: blinn_phong by half-vector density, ggx by visible normals")
CHOICE2(lobe, half_vector, half_vector, reflection, "Mafia DE article, Stochastic Sampling", "what is sampled. half_vector: the normal, which gives the surface's own lobe; reflection: the ray itself, from the lobe of a view along the normal, rotated to the mirror direction")
CHOICE5(pattern, plus, plus, white, blue, sobol, strata, "Mafia III talk, Modified NDF; the talk suggests blue noise", "sequence of the random numbers. plus: each of five neighbours gets a fifth of the azimuth; strata: each of five neighbours gets a fifth of the azimuth and of the angle, and each of 25 pixels one of 5 x 5 cells of both; white: independent; blue: both numbers are stratified over neighbours and frames; sobol: stratified over the rays of a pixel")
CHOICE2(split, solid_angle, cut, solid_angle, "glint; Mafia III talk, Modified NDF", "how rays and pre-filtering divide a lobe. solid_angle: rays are drawn from the whole lobe, and the cone of each covers a fraction of the solid angle that one ray represents, the inverse of its density; cut: as in the Mafia III talk, rays come from the middle of the lobe and one cone covers the remainder")
SPEC(bool,  shuffle,    true, 0, 1, "1", "Mafia III talk, Modified NDF", "the pattern changes every frame; off: a pixel keeps its fifth of the azimuth")
SPEC(bool,  horizon,    true, 0, 1, "1", "glint", "a cone is no wider than its ray's elevation above the surface; off: it may extend below the surface")
SPEC(int,   tries,      16,   1, 64, "draws", "chosen by measuring", "attempts to draw a normal whose ray leaves the surface; after that the normal itself is used")
PUSH(float, share,      1.0,  0.0, 1.0, "1", "Mafia III talk, Importance sampling vs. pre-filtering", "fraction of the lobe's angle that rays cover; pre-filtering covers the rest. 1: no cones")
PUSH(float, threshold,  0.1,  0.001, 0.999, "1", "Mafia III talk, Combining importance sampling with pre-filtering", "lobe value below which split=cut ignores directions when share < 1")
PUSH(float, cone_factor, 1.0, 0.0, 8.0, "1", "chosen by the measured error", "factor on the cone's angle; 0: rays without a cone")
