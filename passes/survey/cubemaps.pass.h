/* Where the active cube maps show the sky. */
PASS("Sky in the cube maps", "glint")
#line 102
SLOT("What a frame holds, for the plan")
READ(texture2DArray, cubemap_color)
READ(texture2DArray, cubemap_distance)
WRITE(uimage2DArray, cubemap_open, R8UI, "1", COCOON, "open", 0, "1: some texels in a square of a face have no distance")
WRITE(uimage2DArray, cubemap_sky, R8UI, "1", COCOON, "sky", 0, "1: some let the sky through; 0 on faces that no ray comes to")
DISPATCH(cubemap_open)
DISPATCH(cubemap_sky)
WITHIN(1)
ALONG_RAYS(cubemap_color, normal_full)
REFERENCE_NONE("it makes no image of the picture")
