/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show water")
WRITE(uimageBuffer, water_tiles, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "as tile_list: tiles with water, then tiles without")
NEEDS(water)
REFERENCE_NONE("it changes the order of work, but no result")
