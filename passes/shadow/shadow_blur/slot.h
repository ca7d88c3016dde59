/* What every variant of this slot reads and writes. */
#line 102
SLOT("The sun's shadow shared between neighbours")
READ(texture2D, shadow_mask)
OPTIONAL_READ(texture2D, shadow_early, R16F, EIGHTH, 0)
READ(texture2D, depth_full)
READ(texture2D, normal_full)
WRITE(image2D, shadow_soft, R16F, "1", FULL, "visibility", 1, "shadow_mask combined with its neighbours")
NEEDS(sun)
NEEDS(surfaces)
REFERENCE_NONE("a pixel of the reference uses only its own lookups")
