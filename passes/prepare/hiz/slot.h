/* What every variant of this slot reads and writes. */
#line 102
SLOT("Pyramid of the depth that rays are traced through")
READ(texture2D, depth_half)
READ(texture2D, normal_half)
WRITE(image2D, hiz, RG32F, "1/m", HALF_MIPS, "near far", 0, "inverse depth of the nearest surface within each cell, -1 where all is sky, and of the farthest within half a texel around it, 0 for sky; level 0: of each texel, whose surface is a plane. Rays go up until the smaller side is under 8")
WRITE(image2D, depth_slopes, RG16F, "1", HALF, "X Y", 0, "part of its inverse depth by which a texel's surface changes over one texel; 0 for sky")
NEEDS(reflecting)
PER_RAY
REFERENCE_NONE("the reference looks at every texel")
