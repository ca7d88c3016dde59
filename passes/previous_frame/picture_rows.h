/* How a picture of the previous frame is sampled. */
#line 302
READ(texture2D, previous_scene)
READ(texture2D, previous_lit)
READ(texture2D, previous_depth)
READ(texture2D, motion_full)
READ(texture2D, motion_depth_full)
WITHOUT(previous_lit, "screen hits show this frame's picture, unless there is the previous scene")
WITHOUT(motion_full, "reprojected with the cameras alone")
CHOICE2(color_source, scene, lit, scene, "Mafia DE article, Global Illumination", "which picture of the previous frame: the finished one, where the capture has it, or the diffuse one")
SPEC(bool,  motion,       true, 0, 1, "1", "Mafia DE article, Global Illumination", "reproject with motion vectors where the capture has them; off: with the cameras only")
SPEC(bool,  reject,       true, 0, 1, "1", "Mafia DE article, Global Illumination", "reject points that were occluded in the previous frame; off: use the colour that is there")
PUSH(float, hidden_depth, 0.02, 0.0, 10.0, "1", "glint", "relative depth difference to the previous frame above which a point counts as occluded there")
