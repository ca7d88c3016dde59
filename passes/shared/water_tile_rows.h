/* As tile_rows.h, of the passes of water. */
#line 42
OPTIONAL_READ(utextureBuffer, water_tiles, R32UI, TILES, 0xFFFFFFFFu)
