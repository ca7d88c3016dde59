/* What every variant of this slot reads and writes. */
#line 102
SLOT("Shadow of the sun without contact shadows")
READ(texture2D, sun_mask)
READ(texture2D, sun_clouds)
WRITE(image2D, shadow_mask, R16F, "1", FULL, "visibility", 1, "1 in the sun, 0 in its shadow; contact shadows are added to it")
CHOICE2(mask, captured, captured, none, "Mafia DE article, Parallel Split Shadows", "captured: contact shadows are combined with the mask of the engine; none: they are all that shades the sun, and compared with the truth's over the same length")
SPEC(bool, clouds, true, 0, 1, "1", "GTA V article, Shadows", "shadows that clouds cast, where the capture has them, are in the mask; off: not")
DISPATCH(shadow_mask)
NEEDS(sun)
NEEDS(surfaces)
ROLE(SHADOW_MASK, mask)
ROLE(DEFINES_RESULT, mask)
ROLE(DEFINES_RESULT, clouds)
