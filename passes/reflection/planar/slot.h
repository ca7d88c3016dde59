/* What every variant of this slot reads and writes. */
#line 102
SLOT("Reflections in a plane, from a mirrored render")
READ(texture2D, water_depth)
READ(texture2D, water_normal)
READ(texture2D, planar_color)
READ(texture2D, planar_depth)
WRITE(image2D, planar_reflection, RGBA16F, "radiance", FULL, "R G B A", 0, "rgb: radiance arriving along the mirror ray; a: 1 where the map shows the end of the ray, 0 where it does not or where there is no water")
DISPATCH(planar_reflection)
DISPATCH_LIST(water_tiles, shown)
NEEDS(planar)
NEEDS(water)
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
