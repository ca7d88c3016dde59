/* What every variant of this slot reads and writes. */
#line 102
SLOT("MIP chain of the picture that screen hits look up")
READ(texture2D, lit)
READ(texture2D, depth_full)
WRITE(image2D, lit_mips, RGBA16F, "radiance", FULL_MIPS, "R G B A", 0, "lit, times a, at level 0; coarser ones stand for a cone. a: share of what counts (cone: of what is not sky)")
NEEDS(reflections)
NEEDS(cones)
REFERENCE_NONE("the reference has rays instead of cones")
REFERENCE_WITH(downsample, "its levels stand for the cones that downsample leaves to them")
