/* What every variant of this slot reads and writes. */
#line 102
SLOT("Diffuse light scattered under the surface")
READ(texture2D, lit)
READ(texture2D, depth_full)
READ(texture2D, skin_width)
WRITE(image2D, lit_scattered, RGBA16F, "radiance", FULL, "R G B A", 0, "lit, blurred where skin is; a: 1")
NEEDS(skin)
