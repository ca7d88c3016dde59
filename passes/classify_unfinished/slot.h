/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which rays the cube maps have to go on with, by roughness class")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
READ(utexture2D, screen_finished)
WRITE(uimageBuffer, cubemap_list, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "pixels that reflect and whose rays did not end on screen: smooth ones, then rough ones; x + 65536 y, or 0xFFFFFFFF, which fills up a class to a multiple of 64")
NEEDS(reflecting)
PER_RAY
