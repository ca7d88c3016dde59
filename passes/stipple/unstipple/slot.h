/* What every variant of this slot reads and writes. */
#line 102
SLOT("Smoothing of stippled surfaces")
READ(texture2D, composed)
OPTIONAL_READ(texture2D, composed_water, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_fog, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_transparent, RGBA16F, FULL, 0)
READ(texture2D, stipple_mask)
WRITE(image2D, unstippled, RGBA16F, "radiance", FULL, "R G B A", 0, "the composed picture, with water and transparent surfaces, in which stippled surfaces are mixed with what shows between them; a as in that picture")
DISPATCH(unstippled)
NEEDS(stippled)
REFERENCE_NONE("it works on the finished picture, which the reference does not compute")
