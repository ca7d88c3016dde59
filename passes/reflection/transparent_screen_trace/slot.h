/* What every variant of this slot reads and writes. */
#line 102
SLOT("Rays of transparent surfaces through the depth buffer")
READ(texture2D, transparent_depth_half)
READ(texture2D, transparent_normal_jittered)
READ(utexture2D, transparent_pick)
READ(texture2D, depth_half)
WRITE(image2D, transparent_screen_travelled, R32F, "m", HALF, "Z", 0, "distance that the ray travelled from its surface, hit or miss; the next tracer starts here")
WRITE(uimage2D, transparent_screen_finished, R8UI, "1", HALF, "finished", 0, "1 where the ray ended on a surface or the sky on screen")
DIAGNOSTIC(uimage2D, transparent_screen_end, R8UI, "end reason", HALF, "reason", 0, "why the ray ended, by passes/shared/end_reasons.h")
DIAGNOSTIC(uimage2D, transparent_screen_steps, R32UI, "steps", HALF, "steps", 0, "steps taken")
DIAGNOSTIC(uimage2D, transparent_screen_fetches, R32UI, "fetches", HALF, "fetches", 0, "texture fetches made")
DISPATCH(transparent_screen_travelled)
DISPATCH_LIST(transparent_tiles, shown)
NEEDS(transparent)
PER_RAY
REFERENCE_NONE("it is composed over the picture and is not part of the reflection that the reference computes")
TRACER("screen (transparent surfaces)", transparent_screen_end)
