/* What every variant of this slot reads and writes. */
#line 102
SLOT("Smooth hull of the space around each cube map (the cocoon), the fallback for rays that hit nothing else")
READ(texture2DArray, cubemap_distance)
WRITE(image2DArray, cocoon_distance, R32F, "m", CUBEMAPS_MIPS, "Z", INFINITY, "distance from the centre. Sky is capped by the cocoon: its distance is negative in levels finer than the cocoon's. The cocoon's level and coarser ones are smooth; +inf only where the whole cube map is sky")
WRITE(image2DArray, cocoon, R16F, "1/m", COCOON, "Z", 0, "the cocoon by itself, as 1 / distance along the face's axis; the outermost samples lie on the border of the face (shared/cocoon.glsl); 0: the whole cube map is sky")
NEEDS(reflections)
NEEDS(cubemaps)
NEEDS(distances)
REFERENCE_NONE("where no cube map sees a ray, the reference continues it until one does")
REFERENCE_WITH(cubemap_trace, "only cubemap_trace reads it")
