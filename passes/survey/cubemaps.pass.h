/* Finds where the active cube maps show the sky. */
PASS("Sky in the cube maps", "glint")
#line 102
SLOT("Statistics of a frame, for the plan")
READ(texture2DArray, cubemap_color)
READ(texture2DArray, cubemap_distance)
WRITE(uimage2DArray, cubemap_open, R8UI, "1", COCOON, "open", 0, "1 where some texels in this square of the face have no distance")
WRITE(uimage2DArray, cubemap_sky, R8UI, "1", COCOON, "sky", 0, "1 where some texels show the sky; 0 on faces that no ray reaches")
DISPATCH(cubemap_open)
DISPATCH(cubemap_sky)
RAY_MARGIN(1)
ALONG_RAYS(cubemap_color, normal_full)
REFERENCE_NONE("it contributes nothing to the picture")
