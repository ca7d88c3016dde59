/* What every variant of this slot reads and writes. */
#line 102
SLOT("Blur of the light that blooms, each resolution by itself")
READ(texture2D, bloom_bright)
NEEDS_MADE(bloom_bright)
WRITE(image2D, bloom_blurred, RGBA16F, "radiance", HALF_MIPS(4), "R G B A", 0, "bloom_bright, blurred; a: 1")
REFERENCE_NONE("bloom is no light of the scene")
