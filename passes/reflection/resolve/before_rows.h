/* What the previous frame showed, and where; of every pass that looks colour up there. */
#line 302
READ(texture2D, previous_scene)
READ(texture2D, previous_lit)
READ(texture2D, previous_depth)
READ(texture2D, motion_full)
READ(texture2D, motion_depth_full)
CHOICE2(picture_of, scene, lit, scene, "Mafia DE article, Global Illumination", "the previous frame's finished picture, where the capture has it, or its diffuse one")
SPEC(bool,  motion,       true, 0, 1, "1", "Mafia DE article, Global Illumination", "go by motion vectors where the capture has them; off: by the cameras alone")
SPEC(bool,  reject,       true, 0, 1, "1", "Mafia DE article, Global Illumination", "points that were hidden in the previous frame are not looked up there; off: they are")
CHOICE2(hidden, cubemap, black, cubemap, "left open by the Mafia DE article", "a hit that the previous frame does not show: is looked up where it lies, in the cube map nearest to it, or is black")
PUSH(float, hidden_depth, 0.02, 0.0, 10.0, "1", "glint", "a point was hidden when the previous depth differs from its own by more than this part")
