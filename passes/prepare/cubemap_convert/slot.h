/* What every variant of this slot reads and writes. */
#line 102
SLOT("The active cube maps in another projection")
READ(textureCubeArray, cubemap_color)
WRITE(image2DArray, paraboloids, RGBA16F, "radiance", PARABOLOIDS_MIPS, "R G B A", 0, "two hemispheres for each cube map, about frame.up, upper one first (shared/paraboloid.glsl); rgb is weighted by a, the share that is not sky")
NEEDS(reflections)
NEEDS(cubemaps)
REFERENCE_NONE("the reference looks cube maps up as they are")
REFERENCE_WITH(cubemap_trace, "cubemap_trace leaves rays to it")
