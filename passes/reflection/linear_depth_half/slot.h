/* What every variant of this slot reads and writes. */
#line 102
SLOT("Linear depth at the pipeline's resolution, for water")
READ(texture2D, depth_full)
WRITE(image2D, linear_depth_half, RG32F, "m", HALF, "depth pick", INFINITY, "depth: view-linear depth of one pixel of each texel; +inf where sky. pick: which one: x + 2y of the pixel within the texel")
DISPATCH(linear_depth_half)
NEEDS(water)
REFERENCE_NONE("what reads it is composed over the picture and is not part of the reflection that the reference computes")
