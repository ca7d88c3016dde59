/* Along rows, then along columns, each colour by the integral of a sum of Gaussians. Only skin at nearly the same depth gives light; of other samples the
   pixel's own colour stands in, so that no light is lost. */
PASS("Rows, then columns", "Mafia DE article, Subsurface Scattering")
#include "slot.h"
#line 202
REFERENCE_NONE("the truths of a capture are of light that does not scatter under surfaces")
WRITE(image2D, lit_across, RGBA16F, "radiance", FULL, "R G B A", 0, "lit after the blur along rows")
READ_OWN(texture2D, across, lit_across)
DISPATCH(lit_across)
DISPATCH(lit_scattered)
SPEC(int,   reach,     12,   1,   32,  "samples", "glint", "samples to each side of the pixel, denser near it")
PUSH(float, width,     1.0,  0.0, 100.0, "1", "d'Eon et al. 2007", "factor on the width of the profile, whose widest Gaussian has a standard deviation of 2.7 mm; 0: nothing is blurred")
PUSH(float, strength,  1.0,  0.0, 1.0, "1", "glint", "how much of the blurred light replaces the captured one; 0: none")
PUSH(float, depth_mm,  10.0, 1e-3, 1e9, "mm", "glint", "difference of depths from which on a sample gives no light; below it the more the less it differs")
