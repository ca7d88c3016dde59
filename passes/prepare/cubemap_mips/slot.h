/* What every variant of this slot reads and writes. */
#line 102
SLOT("MIP chains of the active cube maps")
READ(texture2DArray, cubemap_color)
READ(texture2DArray, cubemap_distance)
WRITE(image2DArray, cubemap_color_mips, RGBA16F, "radiance", CUBEMAPS_MIPS, "R G B A", 0, "cubemap_color at level 0; coarser levels are filtered for cones. rgb is premultiplied by a, the fraction that is not sky")
WRITE(image2DArray, cubemap_distance_mips, R32F, "m", CUBEMAPS_MIPS, "Z", INFINITY, "cubemap_distance at level 0; coarser levels combine four texels, excluding sky; +inf where all four are sky")
NEEDS(reflections)
NEEDS(cones)
NEEDS(cubemaps)
FACT(cubemap_distance_mips)
REFERENCE_WITH(downsample, "its levels represent the cones that downsample assigns to pre-filtering")
