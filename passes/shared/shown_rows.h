/* What decides whether a pixel's reflection is visible at all, for passes that do not read these images otherwise. */
#line 52
READ(texture2D, albedo_full)
READ(texture2D, specular_full)
