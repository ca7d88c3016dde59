/* What every variant of this slot reads and writes. */
#line 102
SLOT("MIP chains of the active cube maps")
READ(texture2DArray, cubemap_color)
READ(texture2DArray, cubemap_distance)
WRITE(image2DArray, cubemap_color_mips, RGBA16F, "radiance", CUBEMAPS_MIPS, "R G B A", 0, "cubemap_color at level 0; coarser ones stand for a cone. rgb is weighted by a, the share that is not sky")
WRITE(image2DArray, cubemap_distance_mips, R32F, "m", CUBEMAPS_MIPS, "Z", INFINITY, "cubemap_distance at level 0; coarser ones join four texels, sky left out; +inf where all are sky")
NEEDS(reflections)
NEEDS(cones)
NEEDS(cubemaps)
FACT(cubemap_distance_mips)
REFERENCE_WITH(downsample, "its levels stand for the cones that downsample leaves to them")
