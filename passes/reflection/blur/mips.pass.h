/* What Mafia III shipped with: a chain of the whole picture, as wide as the cone is where the ray ended. It is blind to
   depth and normal, and leaks. */
PASS("Colour chain by distance", "Mafia III talk, Mafia III approach")
#include "slot.h"
#line 202
READ(texture2D, travelled)
READ(texture2D, cone_half)
WRITE(image2D, reflection_mips, RGBA16F, "radiance", HALF_MIPS, "R G B weight", 0, "reflection_half and its coarser levels; a: the share that has a ray, which weighs rgb")
SELF(texture2D, chain, reflection_mips)
DISPATCH_LEVELS(reflection_mips, 0, -1, down)
DISPATCH(reflection_blurred)
DISPATCH_TILES(shown)
SPEC(bool,  filter_color, true, 0,    1,   "1", "glint", "between levels and texels; off: the nearest of both")
PUSH(float, max_width,      0.25, 0.0,  1.0, "1", "Mafia III talk, Mafia III approach", "largest kernel, as a part of the picture's width; 0: no blur")
