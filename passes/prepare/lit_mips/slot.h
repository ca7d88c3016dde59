/* What every variant of this slot reads and writes. */
#line 102
SLOT("MIP chain of the picture that screen hits sample")
READ(texture2D, lit)
READ(texture2D, depth_full)
WRITE(image2D, lit_mips, RGBA16F, "radiance", FULL_MIPS, "R G B A", 0, "lit times a at level 0; coarser levels are filtered for cones. a: fraction that is not sky")
NEEDS(reflections)
NEEDS(cones)
REFERENCE_NONE("the reference traces rays instead of cones")
REFERENCE_WITH(downsample, "its levels represent the cones that downsample assigns to pre-filtering")
