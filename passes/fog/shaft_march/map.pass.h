/* Steps of equal length to the surface, or to length_m; each counts as much as the fog in it scatters to the camera, which has a closed form. */
PASS("Compared with the shadow map", "GTA V article, light-shaft map")
#include "slot.h"
#line 202
REFERENCE_NONE("the reference has no fog")
SPEC(int,   steps,     32,    1,   1024, "samples", "GTA V article, light-shaft map", "samples along each ray")
CHOICE2(pattern, bayer, middle, bayer, "GTA V article, light-shaft map", "where in its step a sample lies. middle: in its middle; bayer: elsewhere in each texel of a block of 4 x 4, which shaft_blur mixes")
PUSH(float, length_m,  100.0, 0.0, 1e6, "m", "glint", "the fog farther away is lit; 0: all of it")
PUSH(float, bias_part, 1.0,   0.0, 64.0, "1", "glint", "factor on the bias that the engine adds to the stored depth; 0: none")
