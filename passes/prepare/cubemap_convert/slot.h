/* What every variant of this slot reads and writes. */
#line 102
SLOT("The active cube maps in another parameterization")
READ(textureCubeArray, cubemap_color)
WRITE(image2DArray, paraboloids, RGBA16F, "radiance", PARABOLOIDS_MIPS, "R G B A", 0, "two hemispheres per cube map around frame.up, the upper one first (shared/paraboloid.glsl); rgb is premultiplied by a, the fraction that is not sky")
NEEDS(reflections)
NEEDS(cubemaps)
REFERENCE_NONE("the reference samples the cube maps directly")
REFERENCE_WITH(cubemap_trace, "cubemap_trace/dual_paraboloid outputs directions that are looked up in these images")
