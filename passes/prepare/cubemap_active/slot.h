/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which of the capture's cube maps are active, and the order in which rays try them")
WRITE(texture2D, active_index, R32UI, "1", ACTIVE, "index", 0, "index in the capture of each active cube map")
WRITE(texture2D, active_center, RGBA32F, "m", ACTIVE, "X Y Z fade", 0, "centre in camera-relative world space; w: fade")
WRITE(texture2D, active_chain, R32UI, "1", CHAIN, "index", 0, "row i: the active cube maps (indices into active_index) that a ray tries in turn when it starts in cube map i, beginning with i itself")
WRITE(texture2D, active_volume, RGBA32F, "m", VOLUME, "X Y Z W", 0, "row i: inner volume of cube map i: (number of planes, 1 if there is a sphere, 0, 0), then planes (n, d) with n·p + d <= 0 inside, then the sphere (centre, radius); in camera-relative world space")
NEEDS(reflections)
NEEDS(cubemaps)
NEEDED_IF_READ
ROLE(CUBEMAP_ORDER, active_index)
