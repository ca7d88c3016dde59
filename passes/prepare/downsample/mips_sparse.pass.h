/* The variant mips, where rough surfaces have fewer rays: a texel traces none if its lobe is wide enough for a coarser level, and that level's texel
   shows its surface. blur/upscale_blur gives it the colour of that level. */
PASS("Three levels with edges, each with rays of its own", "Mafia DE article, Global Illumination: Reflections Mip 1 to Mip 3")
#include "slot.h"
#include "jitter.h"
#include "pick_rows.h"
#include "mips_rows.h"
#line 502
WRITE(uimage2D, untraced, R8UI, "1", HALF, "untraced", 0, "1 where a texel traces no ray, because a coarser level traces one for its surface; blur/upscale_blur gives it a colour")
READ_OWN(utexture2D, sides, edge_levels)
DISPATCH(untraced)
PUSH(float, mip1_roughness, 0.3, 0.0, 1.0, "1", "chosen by measuring", "max roughness of surfaces that trace a ray in every texel of the pipeline's resolution, which is MIP 1 of the picture; 1: all do")
PUSH(float, mip2_roughness, 0.6, 0.0, 1.0, "1", "chosen by measuring", "max roughness of surfaces that trace a ray in every texel of MIP 2; rougher ones trace one in every texel of MIP 3")
NEEDS_READER(untraced, blur, "texels that trace no ray would stay black")
REFERENCE_WITH(blur, "blur/upscale_blur gives a colour to texels that trace no ray")
