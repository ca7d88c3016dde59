/* What every variant of this slot reads and writes. */
#line 102
SLOT("The picture with reflections")
READ(texture2D, reflection)
READ(texture2D, lit)
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(texture2D, albedo_full)
READ(texture2D, specular_full)
WRITE(image2D, composed, RGBA16F, "radiance", FULL, "R G B A", 0, "lit plus reflection times the environment BRDF; a: 1")
DISPATCH(composed)
