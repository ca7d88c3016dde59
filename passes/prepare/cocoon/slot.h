/* What every variant of this slot reads and writes. */
#line 102
SLOT("Smooth hull of the space around each cube map, for rays that nothing else ends")
READ(texture2DArray, cubemap_distance)
WRITE(image2DArray, cocoon_distance, R32F, "m", CUBEMAPS_MIPS, "Z", INFINITY, "distance; sky is capped, by a negative distance in levels finer than the cocoon's; from that on smooth; +inf only where a whole cube map is sky")
WRITE(image2DArray, cocoon, R16F, "1/m", COCOON, "Z", 0, "the cocoon alone: 1 / distance along the face's axis; samples lie on the borders too (shared/cocoon.glsl); 0: a whole cube map of sky")
NEEDS(reflections)
NEEDS(cubemaps)
REFERENCE_NONE("where no cube map sees a ray, the reference goes on until one does")
REFERENCE_WITH(cubemap_trace, "cubemap_trace alone asks it")
