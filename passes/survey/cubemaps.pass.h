/* Where the active cube maps show the sky. */
PASS("Sky in the cube maps", "glint")
#line 102
SLOT("What a frame holds, for the plan")
READ(texture2DArray, cubemap_color)
READ(texture2DArray, cubemap_distance)
WRITE(uimage2DArray, cubemap_sky, R8UI, "1", COCOON, "sky", 0, "of the texels in a square of a face; 1: some have no distance, 2: some let the sky through")
DISPATCH(cubemap_sky)
REFERENCE_NONE("it makes no image of the picture")
