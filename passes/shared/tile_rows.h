/* The tiles that a pass with rows DISPATCH_TILES is run over; without them, over the whole image. */
#line 42
OPTIONAL_READ(utextureBuffer, tile_list, R32UI, TILES, 0xFFFFFFFFu)
