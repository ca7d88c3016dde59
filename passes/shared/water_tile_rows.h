/* The same as tile_rows.h, for the passes of water. */
#line 42
OPTIONAL_READ(utextureBuffer, water_tiles, R32UI, TILES, 0xFFFFFFFFu)
