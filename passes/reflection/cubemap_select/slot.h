/* What every variant of this slot reads and writes. */
#line 102
SLOT("The cube map in which each ray starts")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
READ(utexture2D, pick)
READ(texture2D, screen_travelled)
READ(utexture2D, screen_finished)
READ(texture2D, active_center)
WRITE(uimage2D, cubemap_best, R8UI, "index", HALF, "index", 255, "index among the active cube maps; 255: none, or the ray has ended already")
DISPATCH(cubemap_best)
DISPATCH_LIST(cubemap_list, shown)
DISPATCH_LIST(tile_list, shown)
NEEDS(reflecting)
NEEDS(cubemaps)
PER_RAY
REFERENCE_WITH(cubemap_trace, "the reference traces every cube map, so that the selection does not matter")
