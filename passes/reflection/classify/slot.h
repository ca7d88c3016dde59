/* What every variant of this slot reads and writes. */
#line 102
SLOT("Which rays are traced on screen, by roughness class")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
WRITE(uimageBuffer, screen_list, R32UI, "1", LIST, "item", 0xFFFFFFFFu, "pixels that reflect, smooth ones before rough ones, in all or in each 32 x 32 pixels; x + 65536 y, or 0xFFFFFFFF, which fills up")
PUSH(float, hq_roughness, 0.1, 0.0, 1.0, "1", "Mafia III talk, Cube-map tracing", "largest roughness of a smooth surface; order alone depends on it, no result")
NEEDS(reflecting)
PER_RAY
REFERENCE_NONE("order of work alone: no result depends on it")
