/* What every variant of this slot reads and writes. */
#line 102
SLOT("Rays of transparent surfaces through the cube maps, from the end of the screen ray")
READ(texture2D, transparent_depth_half)
READ(texture2D, transparent_normal_jittered)
READ(utexture2D, transparent_pick)
READ(texture2D, transparent_screen_travelled)
READ(utexture2D, transparent_screen_finished)
READ(texture2DArray, cubemap_distance)
READ(texture2D, active_center)
READ(utexture2D, active_chain)
WRITE(image2D, transparent_travelled, R32F, "m", HALF, "Z", 0, "distance from the surface to the end of the ray, on screen or in a cube map; +inf: sample by direction only")
WRITE(uimage2D, transparent_place, R8UI, "place", HALF, "place", 255, "place of the cube map in which the ray ended; 255: none (it ended on screen or is black, or in the sky if the distance is +inf)")
DIAGNOSTIC(uimage2D, transparent_cubemap_end, R8UI, "end reason", HALF, "reason", 0, "why the ray ended, by passes/shared/end_reasons.h")
DIAGNOSTIC(uimage2D, transparent_cubemap_steps, R32UI, "steps", HALF, "steps", 0, "steps taken, including refinements and switches")
DIAGNOSTIC(uimage2D, transparent_cubemap_fetches, R32UI, "fetches", HALF, "fetches", 0, "texture fetches made")
DISPATCH(transparent_travelled)
DISPATCH_TILES(shown)
#include "shared/transparent_tile_rows.h"
NEEDS(transparent)
PER_RAY
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
