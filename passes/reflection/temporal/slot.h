/* What every variant of this slot reads and writes. */
#line 102
SLOT("Temporal filter of the half-resolution reflection")
READ(texture2D, reflection_half)
OPTIONAL_READ(texture2D, reflection_blurred, RGBA16F, HALF, -1)
READ(texture2D, depth_half)
READ(texture2D, normal_half)
READ(utexture2D, pick)
READ(texture2D, travelled)
READ(texture2D, motion_full)
WRITE(image2D, reflection_temporal, RGBA16F, "radiance", HALF, "R G B A", -1, "mean of the reflections of this frame and previous ones")
DISPATCH(reflection_temporal)
NEEDS(reflecting)
REFERENCE_NONE("a frame of the reference has enough rays of its own")
