/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show reflections, by roughness class")
WRITE(uimageBuffer, tile_list, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "tiles of 2 x 2 pixels, packed as x + 65536 y and sorted: rough surfaces only, rough and smooth ones, smooth ones only, no visible reflection")
NEEDS(reflecting)
REFERENCE_NONE("it changes the order of work, but no result")
REFERENCE_WITH(upscale, "upscale is the last pass that uses this list and contributes to the reflection")
