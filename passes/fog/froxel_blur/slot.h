/* What every variant of this slot reads and writes. */
#line 102
SLOT("Light in the air without noise")
READ(texture2D, froxel_light)
READ(texture2D, depth_full)
WRITE(image2D, froxel_blurred, RGBA16F, "radiance/m", FROXELS, "R G B A", 0, "froxel_light, blurred where a view ray of the picture passes; cells that surfaces hide are as they were; a: 1")
WRITE(image2D, froxel_far, R32F, "m", FROXEL_SLICE, "Z", INFINITY, "largest depth in the pixels that a cell covers: cells that begin behind it are hidden")
NEEDS(froxels)
REFERENCE_NONE("the reference has no light in the air")
