/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which tiles of the picture show reflections, by roughness class")
WRITE(uimageBuffer, tile_list, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "tiles of 2 x 2 pixels, as x + 65536 y: with rough surfaces only, with both, with smooth ones only, and without a visible reflection")
NEEDS(reflecting)
REFERENCE_NONE("it only orders work: no result depends on it")
REFERENCE_WITH(upscale, "upscale is the last pass that uses this list and contributes to the reflection")
