/* What every variant of this slot reads and writes. */
#line 102
SLOT("Pyramid of the depth that rays are traced through")
READ(texture2D, depth_half)
READ(texture2D, normal_half)
WRITE(image2D, hiz, RG32F, "m", HALF_MIPS, "Z ZBack", INFINITY, "the nearest depth within each cell, and the farthest within half a texel around it; level 0: of each texel, whose surface is a plane. Levels are made until the smaller side is under 8")
WRITE(image2D, depth_slopes, RG16F, "1", HALF, "X Y", 0, "part of its inverse depth by which a texel's surface changes over one texel; 0 for sky")
NEEDS(reflecting)
PER_RAY
