/* What every variant of this slot reads and writes. */
#line 102
SLOT("Temporal filter of the indirect light")
READ(texture2D, indirect_traced)
OPTIONAL_READ(texture2D, indirect_levels, RGBA16F, HALF_MIPS(3), -1)
READ(texture2D, depth_half)
READ(texture2D, normal_half)
READ(utexture2D, pick)
READ(texture2D, motion_full)
WITHOUT(motion_full, "reprojected with the cameras alone")
WRITE(image2D, indirect_temporal, RGBA16F, "radiance", HALF, "R G B missed", -1, "mean of the indirect light of this frame and previous ones")
DISPATCH(indirect_temporal)
NEEDS(bounce)
REFERENCE_NONE("a frame of the reference has enough rays of its own")
