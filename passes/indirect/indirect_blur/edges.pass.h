/* The traced level is blurred along rows, then along columns; each finer level interpolates the coarser one. Nothing crosses edges. */
PASS("Three resolutions", "Mafia DE article, Global Illumination: Diffuse GI Mip 3 Blur H to Mip 1 Upscale Blur")
#include "slot.h"
#line 202
WRITE(image2D, indirect_across, RGBA16F, "radiance", HALF_MIPS(3), "R G B missed", -1, "the traced level after the blur along rows")
READ_OWN(texture2D, across, indirect_across)
READ_OWN(texture2D, levels, indirect_levels)
DISPATCH_LEVELS(indirect_across, 0, 2, down)
DISPATCH_LEVELS(indirect_levels, 0, 2, up)
SPEC(int,   radius,  3,    0,   16,  "texels", "Mafia DE article, Global Illumination; chosen by measuring", "radius of the blur of the traced level; 0: none")
SPEC(bool,  edges,   true, 0,   1,   "1", "Mafia DE article, Downscaled Depth and Normals", "blur and interpolation stop at edges; off: they ignore them")
PUSH(float, normal_part, 0.3, 0.0, 2.0, "1", "glint", "texels beyond an edge are used where no other is, if their normal differs by at most this, as 1 - cosine")
