/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show transparent surfaces")
WRITE(uimageBuffer, transparent_tiles, R32UI, "1", TILES, "item", 0xFFFFFFFFu, "as tile_list: those with a transparent surface, and those without one")
NEEDS(transparent)
REFERENCE_NONE("order of work alone: no result depends on it")
