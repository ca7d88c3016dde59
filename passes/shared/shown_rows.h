/* What says whether a pixel's reflection is shown at all. Next include of a pass that does not read these otherwise. */
#line 52
READ(texture2D, albedo_full)
READ(texture2D, specular_full)
