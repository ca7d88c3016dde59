/* What every variant of this slot reads and writes. */
#line 102
SLOT("Ambient occlusion shared between neighbours")
READ(texture2D, occlusion_half)
READ(texture2D, depth_half)
READ(texture2D, normal_half)
READ(utexture2D, pick)
WRITE(image2D, occlusion_blurred, R16F, "1", HALF, "visibility", 1, "occlusion_half combined with its neighbours")
NEEDS(surfaces)
REFERENCE_NONE("a pixel of the reference uses only its own rays")
