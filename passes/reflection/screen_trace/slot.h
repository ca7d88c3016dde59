/* What every variant of this slot reads and writes. */
#line 102
SLOT("Rays through the depth buffer")
READ(texture2D, depth_half)
READ(texture2D, normal_jittered)
READ(utexture2D, pick)
WRITE(image2D, screen_travelled, R32F, "m", HALF, "Z", 0, "distance that the ray travelled from its surface, hit or miss; the next tracer starts here")
WRITE(uimage2D, screen_finished, R8UI, "1", HALF, "finished", 0, "1 where the ray ended on a surface or the sky on screen")
DIAGNOSTIC(uimage2D, screen_end, R8UI, "end reason", HALF, "reason", 0, "why the ray ended, by passes/shared/end_reasons.h")
DIAGNOSTIC(uimage2D, screen_steps, R32UI, "steps", HALF, "steps", 0, "steps taken")
DIAGNOSTIC(uimage2D, screen_fetches, R32UI, "fetches", HALF, "fetches", 0, "texture fetches made")
DISPATCH(screen_travelled)
OPTIONAL_READ(utextureBuffer, screen_list, R32UI, LIST, 0xFFFFFFFFu)
DISPATCH_LIST(screen_list)
DISPATCH_TILES(shown)
OPTIONAL_READ(utexture2D, screen_rejected, R8UI, HALF, 0)
NEEDS(reflecting)
PER_RAY
PUSH(float, max_roughness, 1.0, 0.0, 1.0, "1", "glint", "surfaces rougher than this are not traced on screen, only in the cube maps; 1: all are traced")
#include "shared/tile_rows.h"
ROLE(RAY_DISTANCE, screen_travelled)
ROLE(SCREEN_FINISHED, screen_finished)
ROLE(SCREEN_END, screen_end)
ROLE(SCREEN_FETCHES, screen_fetches)
