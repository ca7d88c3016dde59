/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which rays are traced on screen, by roughness class")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
WRITE(uimageBuffer, screen_list, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "pixels that reflect: smooth ones, then rough ones; x + 65536 y, or 0xFFFFFFFF, which fills up a class to a multiple of 64")
NEEDS(reflecting)
PER_RAY
