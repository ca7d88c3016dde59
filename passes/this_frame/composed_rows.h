/* The picture with what lies over it: water, sky, fog, transparent surfaces (composed.glsl). */
#line 602
READ(texture2D, composed)
OPTIONAL_READ(texture2D, composed_water, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_sky, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_fog, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_transparent, RGBA16F, FULL, 0)
