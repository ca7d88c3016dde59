/* What every variant of this slot reads and writes. */
#line 102
SLOT("Transparent surfaces over the picture")
READ(texture2D, composed)
OPTIONAL_READ(texture2D, composed_water, RGBA16F, FULL, 0)
READ(texture2D, water_depth)
READ(texture2D, transparent_color)
READ(texture2D, transparent_normal)
READ(texture2D, transparent_depth)
WRITE(image2D, composed_transparent, RGBA16F, "radiance", FULL, "R G B A", 0, "composed, or composed_water, with the nearest transparent surface over it; a is 1")
DISPATCH(composed_transparent)
DISPATCH_LIST(transparent_tiles, shown)
NEEDS(transparent)
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
