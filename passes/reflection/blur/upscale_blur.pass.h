/* The reflection at three resolutions. The coarsest is blurred along rows and columns; each finer level then takes as much of the
   coarser one as its lobe is wider than its texels. Nothing crosses edges. */
PASS("Three resolutions", "Mafia DE article, Global Illumination: Reflections Mip 3 Blur H to Mip 1 Upscale Blur")
#include "slot.h"
#line 202
READ(texture2D, travelled)
READ(utexture2D, edge_levels)
READ(texture2D, normal_levels)
READ(texture2D, vertex_normal_levels)
OPTIONAL_READ(utexture2D, untraced, R8UI, HALF, 0)
WRITE(image2D, reflection_levels, RGBA16F, "radiance", HALF_MIPS(3), "R G B reach", 0, "reflection_half and coarser levels, blurred; a: hit distance divided by the surface's distance from the eye")
WRITE(image2D, reflection_across, RGBA16F, "radiance", EIGHTH, "R G B reach", 0, "the coarsest level after the blur along rows")
READ_OWN(texture2D, levels, reflection_levels)
READ_OWN(texture2D, across, reflection_across)
DISPATCH_LEVELS(reflection_levels, 0, 2, down)
DISPATCH(reflection_across)
DISPATCH_LEVELS(reflection_levels, 2, 2, down)
DISPATCH_LEVELS(reflection_levels, 1, 1, up)
DISPATCH(reflection_blurred)
DISPATCH_LIST(tile_list, shown)
SPEC(int,   radius,  3,   0,   16,  "texels", "Mafia DE article, Global Illumination; chosen by measuring", "radius of the blur of the coarsest level; 0: none")
SPEC(bool,  edges,   true, 0,  1,   "1", "Mafia DE article, Downscaled Depth and Normals", "the blur stops at edges; off: it ignores them")
PUSH(float, roughness_part, 0.1, 0.0, 1.0, "1", "glint", "samples beyond an edge are weighted by the agreement of their lobes, which is 0 when roughness differs by more than this")
PUSH(float, width,   0.5, 0.0, 8.0, "1", "chosen by the measured error", "fraction of the lobe's width over which a pixel takes its neighbours' samples; 0: no blur")
