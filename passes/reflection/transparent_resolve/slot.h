/* What every variant of this slot reads and writes. */
#line 102
SLOT("Colour at the ends of transparent surfaces' rays")
READ(texture2D, transparent_depth_half)
READ(texture2D, transparent_normal_jittered)
READ(texture2D, transparent_normal)
READ(utexture2D, transparent_pick)
READ(texture2D, transparent_travelled)
READ(utexture2D, transparent_screen_finished)
READ(utexture2D, transparent_cubemap_index)
READ(texture2D, transparent_cone)
WRITE(image2D, transparent_reflection, RGBA16F, "radiance", HALF, "R G B A", 0, "rgb: radiance arriving along the ray; a: 1 where the ray found a colour")
DISPATCH(transparent_reflection)
DISPATCH_LIST(transparent_tiles, shown)
NEEDS(transparent)
PER_RAY
ACCUMULATE(transparent_reflection)
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
