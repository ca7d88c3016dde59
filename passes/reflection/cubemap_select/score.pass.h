/* The cube map with the best score where the screen ray ended. */
PASS("Best score", "Mafia III talk, Best cube-map selection, GPU")
#include "slot.h"
#line 202
READ(textureCubeArray, cubemap_distance)
ALONG_RAYS(cubemap_distance, normal_jittered)
OPTIONAL_READ(utextureBuffer, cubemap_list, R32UI, LIST, 0xFFFFFFFFu)
DISPATCH_LIST(cubemap_list)
PUSH(float, visibility, 0.1,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of: the ray's beginning is seen from the centre; 0: off")
PUSH(float, distance,   1.0,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of: the centre is near; 0: off")
PUSH(float, direction,  0.1,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of: the ray goes away from the centre; 0: off")
PUSH(float, fade,       1.0,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of: the cube map is not being faded; 0: off")
PUSH(float, near_m,     3.0,  0.01, 1e4, "m", "Mafia III talk, Best cube-map selection (not printed); chosen by measuring", "distance at which its term is a half")
PUSH(float, ahead_m,    0.5,  0.0, 1e4, "m", "Mafia III talk, Best cube-map selection (not printed); chosen by measuring", "how far along the ray its beginning is looked for: a surface that is seen at a grazing angle hides itself behind its own texels")
PUSH(float, tolerance,  0.03, 0.0, 1.0,  "1", "Mafia III talk, Best cube-map selection (not printed); chosen by measuring", "part of the distance by which a point may lie behind what is seen")
