/* What every variant of this slot reads and writes. */
#line 102
SLOT("Colour at the ends of rays")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
READ(utexture2D, pick)
WRITE(image2D, reflection_half, RGBA16F, "radiance", HALF, "R G B A", 0, "rgb: radiance arriving along the ray; a: 1 where the ray found a colour")
DISPATCH(reflection_half)
DISPATCH_LIST(tile_list, shown)
NEEDS(reflecting)
PER_RAY
ACCUMULATE(reflection_half)
ROLE(RAY_RADIANCE, reflection_half)
ROLE(DEFINES_RESULT, fog)
ROLE(DEFINES_RESULT, fog_target)
