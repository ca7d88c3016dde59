/* What every variant of this slot reads and writes. */
#line 102
SLOT("Where surfaces are that may occlude others")
READ(texture2D, depth_half)
READ(utexture2D, pick)
WRITE(image2D, bounds_low, RGBA32F, "m", HALF_MIPS, "X Y Z surfaces", 0, "lowest coordinates of the surfaces in a cell, along the axes of the world from the camera; w: 1, or 0 where it has none")
WRITE(image2D, bounds_high, RGBA32F, "m", HALF_MIPS, "X Y Z surfaces", 0, "highest coordinates of them")
NEEDS(surfaces)
PER_RAY
REFERENCE_NONE("it saves work, but changes no result")
