/* What every variant of this slot reads and writes. */
#line 102
SLOT("Where the sun's shadow is not blurred")
READ(texture2D, shadow_mask)
WRITE(image2D, shadow_early, R16F, "1", EIGHTH, "visibility", 0, "no pixel of this texel's block and of the blocks around it sees less of the sun")
NEEDS(sun)
NEEDS(surfaces)
REFERENCE_NONE("it saves work and changes no pixel")
