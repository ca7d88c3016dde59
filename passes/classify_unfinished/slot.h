/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which rays the cube maps have to go on with, by roughness class")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
READ(utexture2D, screen_finished)
WRITE(uimage2D, cubemap_list, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "unfinished pixels: smooth ones, then rough ones; then finished ones, whose distance is handed on; x + 65536 y, or 0xFFFFFFFF, which fills up a class to a multiple of 64")
NEEDS(reflecting)
PER_RAY
