/* The stencil class `skin`, and the engine's own mask in it. */
PASS("By class and mask", "GTA V article, Subsurface Scattering; Mafia DE article, Subsurface Scattering")
#include "slot.h"
#line 202
REFERENCE_NONE("the truths of a capture are of light that does not scatter under surfaces")
SPEC(bool,  stencil,   true, 0, 1, "1", "GTA V article, Subsurface Scattering", "only pixels of the stencil class `skin` count, where the capture has that class; off: the mask alone says which")
SPEC(bool,  mask,      true, 0, 1, "1", "GTA V article, Subsurface Scattering", "the engine's own mask is a factor, where the capture has it; off: the class alone counts")
