/* What every variant of this slot reads and writes. */
#line 102
SLOT("Sunlight in the fog at full resolution")
READ(texture2D, shaft_half)
READ(texture2D, depth_half)
READ(texture2D, depth_full)
WRITE(image2D, shafts, R16F, "1", FULL, "lit", 1, "shaft_half, mixed with what lies as far away, at full resolution")
NEEDS(shafts)
