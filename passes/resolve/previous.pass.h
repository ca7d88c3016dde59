/* What a hit on screen shows is looked up in the previous frame, where the hit's motion leads; where that point was hidden or
   outside of the picture, in the cube maps. */
PASS("Colour of the previous frame", "001, Global Illumination; Stochastic Sampling")
#include "slot.h"
OPTIONAL_READ(texture2D, cone_half, R16F, HALF, 0)
#include "sources.h"
#line 302
READ(texture2D, previous_scene)
READ(texture2D, previous_lit)
READ(texture2D, previous_depth)
READ(texture2D, motion_full)
READ(texture2D, motion_depth_full)
READ(utexture2D, cubemap_best)
DIAGNOSTIC(uimage2D, previous_source, R8UI, "1", HALF, "source", 0, "where a hit on screen found its colour: 1: in the previous frame, 2: its point was outside of the picture or behind the camera, 3: it was hidden; 0: no hit on screen")
CHOICE2(picture_of, scene, lit, scene, "001, Global Illumination", "the previous frame's finished picture, where the capture has it, or its diffuse one")
SPEC(bool,  motion,       true, 0, 1, "1", "001, Global Illumination", "go by motion vectors where the capture has them; off: by the cameras alone")
SPEC(bool,  reject,       true, 0, 1, "1", "001, Global Illumination", "points that were hidden in the previous frame are not looked up there; off: they are")
CHOICE2(hidden, cubemap, black, cubemap, "001 leaves it open", "a hit that the previous frame does not show: is looked up where it lies, in the pixel's best cube map, or is black")
PUSH(float, hidden_depth, 0.02, 0.0, 10.0, "1", "glint", "a point was hidden when the previous depth differs from its own by more than this part")
