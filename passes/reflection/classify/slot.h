/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which rays are traced on screen, by roughness class")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
WRITE(uimageBuffer, screen_list, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "as tile_list: tiles from which rays are traced, then tiles without")
PUSH(float, hq_roughness, 0.1, 0.0, 1.0, "1", "Mafia III talk, Cube-map tracing", "max roughness of a smooth surface; affects only the order of work, not the results")
NEEDS(reflecting)
PER_RAY
REFERENCE_NONE("it changes the order of work, but no result")
