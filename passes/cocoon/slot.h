/* What every variant of this slot reads and writes. */
#line 102
SLOT("Smooth hull of the space around each cube map, for rays that nothing else ends")
READ(texture2DArray, cubemap_distance)
WRITE(image2DArray, cocoon_distance, R32F, "m", CUBEMAPS_MIPS, "Z", INFINITY, "distance with sky capped; from the cocoon's level on smooth; +inf only where a whole cube map is sky")
NEEDS(reflecting)
NEEDS(cubemaps)
