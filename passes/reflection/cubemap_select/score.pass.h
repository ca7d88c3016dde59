/* Selects the cube map with the best score for the end of the screen ray. */
PASS("Best score", "Mafia III talk, Best cube-map selection, GPU")
#include "slot.h"
#line 202
READ(textureCubeArray, cubemap_distance)
WITHOUT(cubemap_distance, "every cube map counts as seeing the ray")
ALONG_RAYS(cubemap_distance, normal_jittered)
PUSH(float, visibility, 0.1,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of visibility: the ray's start is visible from the centre; 0: off")
PUSH(float, distance,   1.0,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of distance: the centre is near; 0: off")
PUSH(float, direction,  0.1,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of direction: the ray points away from the centre; 0: off")
PUSH(float, fade,       1.0,  0.0, 16.0, "1", "Mafia III talk, Best cube-map selection, GPU", "weight of fade: the cube map is not fading; 0: off")
PUSH(float, near_m,     3.0,  0.01, 1e4, "m", "Mafia III talk, Best cube-map selection (not printed); chosen by measuring", "distance at which the distance term is one half")
PUSH(float, ahead_m,    0.5,  0.0, 1e4, "m", "Mafia III talk, Best cube-map selection (not printed); chosen by measuring", "how far along the ray visibility is tested: at a grazing angle a surface would occlude itself with its own texels")
PUSH(float, tolerance,  0.03, 0.0, 1.0,  "1", "Mafia III talk, Best cube-map selection (not printed); chosen by measuring", "relative distance by which a visible point may lie behind the cube map's surface")
