/* What every variant of this slot reads and writes. */
#line 102
SLOT("Fog over the picture")
READ(texture2D, composed)
OPTIONAL_READ(texture2D, composed_water, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_sky, RGBA16F, FULL, 0)
READ(texture2D, water_depth)
READ(texture2D, depth_full)
OPTIONAL_READ(texture2D, shafts, R16F, FULL, 1)
WRITE(image2D, composed_fog, RGBA16F, "radiance", FULL, "R G B A", 0, "composed, composed_water or composed_sky, as it is seen through the fog; transparent surfaces come over it; a is 1")
DISPATCH(composed_fog)
NEEDS(fog)
REFERENCE_NONE("it works on the picture, and the reference is compared with truths that have no fog")
