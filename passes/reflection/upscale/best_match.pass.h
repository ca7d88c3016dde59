/* Takes one of the surrounding samples, the one whose surface matches the pixel's best. */
PASS("Best match of depth and normal", "Mafia III talk, Upscale")
#include "slot.h"
DISPATCH(depth_half)
DISPATCH_LIST(tile_list, shown)
#line 202
WRITE(uimage2D, sharp_source, R8UI, "1", FULL, "choice", 255, "0: a rough pixel; else a smooth one, and the value is the chosen texel among the 3 x 3 around its own, 1 + x + 3y, 5 in the middle")
SPEC(bool,  around,           true,  0,   1,    "1", "chosen by measuring", "consider all eight texels around the pixel's own; off: the four nearest")
PUSH(float, depth_weight,     100.0, 0.0, 1e6,  "1", "Mafia III talk, Upscale; chosen by measuring", "cost of a sample's distance from the pixel's plane, relative to the depth; 0: ignore depth")
PUSH(float, normal_weight,    25.0,  0.0, 1e6,  "1", "Mafia III talk, Upscale; chosen by measuring", "cost of the squared difference of the normals; 0: ignore normals")
PUSH(float, roughness_weight, 10.0,  0.0, 1e6,  "1", "chosen by measuring", "cost of a difference of roughness; 0: ignore roughness")
PUSH(float, distance_weight,  0.02,  0.0, 1e6,  "1/px²", "chosen by measuring", "cost of the squared distance in the picture, which decides on uniform surfaces")
PUSH(float, sharp_roughness,  0.1,   0.0, 1.0,  "1", "Mafia III talk, Color resolve passes", "max roughness of a smooth pixel")
