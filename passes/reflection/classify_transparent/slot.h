/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show transparent surfaces")
WRITE(uimageBuffer, transparent_tiles, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "as tile_list: tiles with a transparent surface, then tiles without")
NEEDS(transparent)
REFERENCE_NONE("it changes the order of work, but no result")
