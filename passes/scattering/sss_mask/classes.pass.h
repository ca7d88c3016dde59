/* The stencil class `skin`, and the engine's own mask in it; narrower where the surface is flat. */
PASS("By class, mask and curvature", "GTA V article, Subsurface Scattering; Mafia DE article, Subsurface Scattering")
#include "slot.h"
#line 202
REFERENCE_NONE("the truths of a capture are of light that does not scatter under surfaces")
SPEC(bool,  stencil,   true, 0, 1, "1", "GTA V article, Subsurface Scattering", "only pixels of the stencil class `skin` count, where the capture has that class; off: the mask alone says which")
SPEC(bool,  mask,      true, 0, 1, "1", "GTA V article, Subsurface Scattering", "the engine's own mask is a factor, where the capture has it; off: the class alone counts")
SPEC(bool,  curvature, true, 0, 1, "1", "Mafia DE article, Subsurface Scattering", "flat skin has a narrower width than skin that bends, where the capture has curvature; off: all has the same")
PUSH(float, flat_part, 0.5,  0.0, 1.0, "1", "glint", "width of flat skin as a part of the full one; 1: curvature has no effect")
PUSH(float, bent_mm,   10.0, 0.1, 1e4, "mm", "glint", "radius of a sphere that bends so much that its skin has the full width; between it and a plane the width changes evenly with 1 / radius")
