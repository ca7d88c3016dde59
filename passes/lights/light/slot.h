/* What every variant of this slot reads and writes. */
#line 102
SLOT("Direct light of lamps")
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(texture2D, albedo_full)
READ(texture2D, shadow_map)
WITHOUT(shadow_map, "lamps cast no shadows")
OPTIONAL_READ(utexture2D, light_mask, R32UI, FULL, 0xFFFFFFFFu)
WRITE(image2D, light, RGBA16F, "radiance", FULL, "R G B A", 0, "direct light of all lamps that the surface sends back, by its diffuse albedo; a: 1")
DISPATCH(light)
NEEDS_BY(lamplit_within, range)
REFERENCE_NONE("the light of lamps has a closed form, and their shadows are those of the engine's maps")
