/* The picture that the pipeline has made so far (picture.glsl). */
#line 602
READ(texture2D, composed)
OPTIONAL_READ(texture2D, composed_water, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, composed_transparent, RGBA16F, FULL, 0)
OPTIONAL_READ(texture2D, antialiased, RGBA16F, FULL, 0)
