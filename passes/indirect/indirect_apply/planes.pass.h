/* Interpolates those of the four nearest texels that lie in the pixel's plane and face its way. */
PASS("Bilinear within planes", "Mafia DE article, Downscaled Depth and Normals")
#include "slot.h"
#line 202
PUSH(float, depth_part,  0.02, 0.0, 10.0, "1", "chosen by measuring", "a texel farther from the pixel's plane than this fraction of the depth gets almost no weight; 10: no test")
PUSH(float, normal_part, 0.3,  0.0, 2.0,  "1", "chosen by measuring", "a texel whose normal differs by more than this, as 1 - cosine, gets almost no weight; 2: no test")
