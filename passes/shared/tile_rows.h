/* The tiles that a pass with a row DISPATCH_TILES covers; without a list it covers the whole image. */
#line 42
OPTIONAL_READ(utextureBuffer, tile_list, R32UI, TILES, 0xFFFFFFFFu)
