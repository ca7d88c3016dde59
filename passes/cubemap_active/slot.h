/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which of the capture's cube maps take part, and in which order they are tried")
WRITE(texture2D, active_index, R32UI, "1", ACTIVE, "index", 0, "number of the capture's cube map in each place")
WRITE(texture2D, active_center, RGBA32F, "m", ACTIVE, "X Y Z fade", 0, "centre, camera-relative world; w: fade")
WRITE(texture2D, active_chain, R32UI, "1", CHAIN, "place", 0, "row i: places to try when a ray starts in cube map i, itself first")
WRITE(texture2D, active_volume, RGBA32F, "m", VOLUME, "X Y Z W", 0, "row i: inner volume of cube map i: (number of planes, 1 with a sphere, 0, 0), planes (n, d) with n·p + d <= 0 inside, sphere (centre, radius); camera-relative world")
NEEDS(reflections)
NEEDS(cubemaps)
ROLE(CUBEMAP_ORDER, active_index)
