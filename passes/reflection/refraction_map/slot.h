/* What every variant of this slot reads and writes. */
#line 102
SLOT("What is behind water, as a picture of its own")
READ(texture2D, composed)
READ(texture2D, water_depth)
READ(texture2D, water_normal)
READ(texture2D, water_color)
READ(texture2D, water_caustics)
WRITE(image2D, refraction_map, RGBA16F, "radiance", HALF, "R G B A", 0, "rgb: light that reaches the water's surface from below, with what the water scatters, as the mean of the texel's pixels with water; a: their fraction; 0 without water")
DISPATCH(refraction_map)
DISPATCH_LIST(water_tiles, shown)
NEEDS(water)
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
