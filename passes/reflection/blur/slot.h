/* What every variant of this slot reads and writes. */
#line 102
SLOT("Reflections shared between neighbours")
READ(texture2D, reflection_half)
READ(texture2D, depth_half)
READ(texture2D, normal_half)
READ(utexture2D, pick)
WRITE(image2D, reflection_blurred, RGBA16F, "radiance", HALF, "R G B A", -1, "reflection_half combined with its neighbours")
NEEDS(reflecting)
REFERENCE_NONE("a pixel of the reference uses only its own rays")
