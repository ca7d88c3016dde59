/* What every variant of this slot reads and writes. */
#line 102
SLOT("Rays through the cube maps, from the end of the screen ray")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
READ(utexture2D, pick)
READ(texture2D, screen_travelled)
READ(utexture2D, screen_finished)
READ(utexture2D, cubemap_best)
READ(texture2DArray, cubemap_distance)
ALONG_RAYS(cubemap_distance, normal_jittered)
READ(texture2D, active_center)
READ(utexture2D, active_chain)
WRITE(image2D, travelled, R32F, "m", HALF, "Z", 0, "distance from the surface to the end of the ray, on screen or in a cube map; +inf: sample by direction only")
WRITE(uimage2D, cubemap_index, R8UI, "place", HALF, "place", 255, "place of the cube map in which the ray ended; 255: none (it ended on screen or is black, or in the sky if travelled is +inf)")
DIAGNOSTIC(uimage2D, cubemap_end, R8UI, "end reason", HALF, "reason", 0, "why the ray ended, by passes/shared/end_reasons.h")
DIAGNOSTIC(uimage2D, cubemap_steps, R32UI, "steps", HALF, "steps", 0, "steps taken, including refinements and switches")
DIAGNOSTIC(uimage2D, cubemap_fetches, R32UI, "fetches", HALF, "fetches", 0, "texture fetches made")
DISPATCH(travelled)
DISPATCH_TILES(shown)
NEEDS(reflecting)
PER_RAY
#include "shared/tile_rows.h"
