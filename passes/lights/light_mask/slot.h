/* What every variant of this slot reads and writes. */
#line 102
SLOT("Pixels that lights touch")
READ(texture2D, depth_full)
WRITE(uimage2D, light_mask, R32UI, "1", FULL, "bits", 0xFFFFFFFFu, "a bit for each of the 32 lamps that cover most of the screen, in that order: 0 where the lamp lights nothing. Lamps without a mask have their bit set everywhere")
DISPATCH(light_mask)
NEEDS(lamplit)
REFERENCE_NONE("it changes no bit of the light")
