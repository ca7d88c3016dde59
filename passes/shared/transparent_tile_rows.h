/* The same as tile_rows.h, for the passes of transparent surfaces. */
#line 42
OPTIONAL_READ(utextureBuffer, transparent_tiles, R32UI, TILES, 0xFFFFFFFFu)
