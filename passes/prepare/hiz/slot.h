/* What every variant of this slot reads and writes. */
#line 102
SLOT("Hi-Z pyramid of the depth buffer that rays are traced through")
READ(texture2D, depth_half)
READ(texture2D, normal_half)
WRITE(image2D, hiz, RG32F, "1/m", HALF_MIPS, "near far", 0, "near: inverse depth of the nearest surface in the cell, -1 where the cell is all sky; far: inverse depth of the farthest surface in the cell and half a texel around it, 0 for sky. In level 0 each texel is a plane. The coarsest level that rays use is the first whose smaller side is under 8 texels")
WRITE(image2D, depth_slopes, RG16F, "1", HALF, "X Y", 0, "relative change of inverse depth across one texel, along x and y; 0 for sky")
NEEDS(reflecting)
NEEDED_IF_READ
PER_RAY
REFERENCE_NONE("the reference visits every texel")
