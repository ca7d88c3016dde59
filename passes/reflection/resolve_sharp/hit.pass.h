/* Mirror rays about the full-resolution normals, as long as the best matching half-resolution ray. */
PASS("Colour at the hit", "Mafia III talk, Color resolve passes")
#include "slot.h"
OPTIONAL_READ(utexture2D, sharp_source, R8UI, FULL, 255)
#include "reflection/resolve/ends.h"
#include "reflection/resolve/sources.h"
#line 302
CHOICE2(ndf, ggx, blinn_phong, ggx, "Mafia III talk, Modified NDF; GGX is its future work", "NDF of the cone; must equal downsample.ndf")
PUSH(float, sharp_roughness, 0.1,   0.0, 1.0,  "1", "Mafia III talk, Color resolve passes", "max roughness that is resolved at full resolution; 0: perfect mirrors only")
PUSH(float, blend,          0.02,  0.0, 1.0,  "1", "glint", "range of roughness below that limit over which the upscaled reflection takes over; 0: a hard switch")
SPEC(bool,  neighbours,  false, 0,   1,    "1", "glint", "where the mirror ray of the pixel misses what the chosen ray hit on screen, or the chosen ray hit nothing there, take the nearest hit of the four rays around the pixel that lies on the mirror ray; off: the chosen ray decides")
NEEDS_BY(smooth, sharp_roughness)
DISPATCH_LIST_BY(tile_list, smooth, sharp_roughness)
PUSH(float, threshold,      0.1,  0.001, 0.999, "1", "Mafia III talk, Combining importance sampling with pre-filtering", "lobe value at the rim of the cone, which represents the whole lobe here")
PUSH(float, cone_factor,    1.0,   0.0, 8.0,  "1", "chosen by the measured error", "factor on the cone's angle; 0: rays without a cone")
ALONG_RAYS(cubemap_color, normal_full)
