/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show water")
WRITE(uimageBuffer, water_tiles, R32UI, "1", TILES, "item", 0xFFFFFFFFu, "as tile_list: those with water, and those without")
NEEDS(water)
REFERENCE_NONE("order of work alone: no result depends on it")
