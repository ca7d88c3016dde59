/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show reflections, by roughness class")
WRITE(uimageBuffer, tile_list, R32UI, "1", TILES, "item", 0xFFFFFFFFu, "2 x 2 pixels each, x + 65536 y, and where a CPU looks cube maps up another list behind it, of 16 x 2 pixels each: those with rough surfaces alone, with rough and smooth ones, with smooth ones alone, without any that the picture shows")
NEEDS(reflecting)
REFERENCE_NONE("order of work alone: no result depends on it")
REFERENCE_WITH(upscale, "upscale is the last to work along it, and to add to the reflection")
