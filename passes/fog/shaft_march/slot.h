/* What every variant of this slot reads and writes. */
#line 102
SLOT("Sunlight in the fog along view rays")
READ(texture2D, depth_half)
READ(utexture2D, pick)
READ(texture2D, shadow_map)
WRITE(image2D, shaft_half, R16F, "1", HALF, "lit", 1, "of the light that the fog in front of the surface scatters to the camera, the part whose air no surface shades; 1: all of it")
DISPATCH(shaft_half)
NEEDS(shafts)
