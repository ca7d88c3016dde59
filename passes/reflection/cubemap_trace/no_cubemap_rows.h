/* What rays find in a frame without cube maps: sky.glsl. */
#line 702
CHOICE3(no_cubemap, seen, seen, sky, black, "glint", "what a ray finds that leaves the screen of a frame without cube maps. sky: the sky, or the capture's probe; black: nothing; seen: the probe; without one, the sky, if it fills at least open_share of what the picture shows above the horizon; and nothing where they show painted ground")
SPEC(float, open_share, 0.25, 0.0, 1.0, "1", "chosen by measuring", "for no_cubemap=seen: min fraction of the picture above the horizon that shows sky; 0: as no_cubemap=sky, where anything above the horizon is in the picture")
