/* What every variant of this slot reads and writes. */
#line 102
SLOT("Indirect light shared between neighbours, and upscaled to the pipeline's resolution")
READ(texture2D, indirect_traced)
READ_AS(utexture2D, edge_levels, surface_edges)
READ_AS(texture2D, vertex_normal_levels, surface_levels)
WRITE(image2D, indirect_levels, RGBA16F, "radiance", HALF_MIPS(3), "R G B missed", -1, "indirect_traced, the level that was traced blurred, and the finer ones upscaled from it")
NEEDS(bounce)
REFERENCE_NONE("a pixel of the reference uses only its own rays")
