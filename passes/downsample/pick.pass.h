/* One pixel of each 2x2 block, never a mixture. */
PASS("Edge-aware pick", "000, G-buffer down-sampling and jittering")
#include "slot.h"
SPEC(bool,  edges,      true, 0, 1, "1", "000, G-buffer down-sampling", "discard the minority side of a depth discontinuity (of two pairs, the farther); off: take any pixel")
SPEC(bool,  alternate,  true, 0, 1, "1", "000, G-buffer down-sampling", "take another pixel of the block in each frame; off: the first that remains")
SPEC(bool,  jitter,     true, 0, 1, "1", "000, G-buffer down-sampling", "draw the normal from the NDF; off: mirror rays")
CHOICE2(ndf, ggx, blinn_phong, ggx, "000, Modified NDF; GGX is its future work", "distribution that jitters the normal: blinn_phong by half-vector density, ggx by visible normals")
SPEC(int,   tries,      16,   1, 64, "draws", "chosen by measuring", "normals drawn until the ray leaves the surface; then the normal itself is taken")
PUSH(float, share,      1.0,  0.0, 1.0, "1", "000, Importance sampling vs. pre-filtering", "part of the NDF's angle that rays cover; the rest is left to pre-filtering")
PUSH(float, threshold,  0.1,  0.001, 0.999, "1", "000, Combining importance sampling with pre-filtering", "lobe value below which directions are ignored when share < 1")
PUSH(float, edge_depth, 0.05, 0.0, 10.0, "1", "chosen by measuring", "relative depth difference that makes a discontinuity")
