/* What every variant of this slot reads and writes. */
#line 102
SLOT("The nearest transparent surface at the pipeline's resolution")
READ(texture2D, transparent_color)
READ(texture2D, transparent_normal)
READ(texture2D, transparent_depth)
WRITE(image2D, transparent_depth_half, R32F, "m", HALF, "Z", INFINITY, "view-linear depth of the picked surface; +inf where there is none")
WRITE(image2D, transparent_normal_jittered, RGBA16F, "1", HALF, "X Y Z roughness", 0, "normal that determines its ray, in world space; w: roughness")
WRITE(image2D, transparent_cone, R16F, "rad", HALF, "angle", 0, "half-angle of the cone that the ray represents; 0: a ray")
WRITE(uimage2D, transparent_pick, R8UI, "1", HALF, "index", 0, "which pixel of the 2x2 block was picked: x + 2y")
DISPATCH(transparent_depth_half)
DISPATCH_LIST(transparent_tiles, shown)
NEEDS(transparent)
PER_RAY
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
