/* What every variant of this slot reads and writes. */
#line 102
SLOT("MIP chain of the sky")
READ(texture2DArray, sky)
WRITE(image2DArray, sky_mips, RGBA16F, "radiance", SKY_MIPS, "R G B A", 0, "sky at level 0; coarser levels are filtered for cones")
NEEDS(reflections)
NEEDS(cones)
NEEDS(sky_seen)
REFERENCE_NONE("the reference traces rays instead of cones")
REFERENCE_WITH(downsample, "its levels represent the cones that downsample assigns to pre-filtering")
