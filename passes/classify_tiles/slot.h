/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show reflections, by roughness class")
WRITE(uimageBuffer, tile_list, R32UI, "1", TILES, "item", 0xFFFFFFFFu, "x + 65536 y, 2 x 2 pixels each, on a CPU 16 x 2: those with rough surfaces alone, with rough and smooth ones, with smooth ones alone, without any that the picture shows")
NEEDS(reflecting)
REFERENCE_NONE("order of work alone: no result depends on it")
REFERENCE_WITH(upscale, "upscale is the last to work along it, and to add to the reflection")
