/* What every variant of this slot reads and writes. */
#line 102
SLOT("Reflection at full resolution")
READ(texture2D, reflection_half)
READ(texture2D, depth_half)
READ(texture2D, normal_half)
READ(utexture2D, pick)
READ(texture2D, depth_full)
READ(texture2D, normal_full)
WRITE(image2D, reflection, RGBA16F, "radiance", FULL, "R G B A", 0, "reflection_half at full resolution")
DISPATCH(reflection)
NEEDS(reflecting)
