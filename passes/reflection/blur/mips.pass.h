/* What Mafia III shipped with: a MIP chain of the whole picture, sampled as wide as the cone is at the hit. It ignores depth
   and normal, and leaks. */
PASS("Colour chain by distance", "Mafia III talk, Mafia III approach")
#include "slot.h"
#line 202
READ(texture2D, travelled)
READ(texture2D, cone_half)
WRITE(image2D, reflection_mips, RGBA16F, "radiance", HALF_MIPS, "R G B weight", 0, "reflection_half and its coarser levels; rgb is premultiplied by a, the fraction that has a ray")
READ_OWN(texture2D, chain, reflection_mips)
DISPATCH_LEVELS(reflection_mips, 0, -1, down)
DISPATCH(reflection_blurred)
DISPATCH_LIST(tile_list, shown)
SPEC(bool,  filter_color, true, 0,    1,   "1", "glint", "interpolate between levels and texels; off: the nearest of both")
PUSH(float, max_width,      0.25, 0.0,  1.0, "1", "Mafia III talk, Mafia III approach", "max width of the kernel, as a fraction of the picture's width; 0: no blur")
