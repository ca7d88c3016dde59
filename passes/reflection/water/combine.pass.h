/* What is behind the water and what it mirrors, in one picture. */
PASS("Refraction and reflection combined", "GTA V article, Water")
#include "slot.h"
#line 202
SPEC(bool,  refraction, true, 0, 1, "1", "GTA V article, Water", "the bottom is seen where the refracted ray meets it; off: straight through")
SPEC(int,   refinements, 2,   0, 8, "1", "glint", "times the bottom's depth is looked up again where the refracted ray would meet it")
SPEC(bool,  depth,      true, 0, 1, "1", "GTA V article, Water (green channel of the opacity map)", "the way through the water takes light and gives the water's own; off: every way is a metre long")
SPEC(bool,  fresnel,    true, 0, 1, "1", "glint; the article says nothing", "reflected share by angle; off: that of vertical incidence")
SPEC(bool,  environment, true, 0, 1, "1", "GTA V article, Environment Cubemap", "what the planar map does not show comes from the cube map nearest to the player; off: from the sky alone")
PUSH(float, index,      1.333, 1.0, 4.0, "1", "glint", "refractive index")
PUSH(float, intensity,  1.0,  0.0, 16.0, "1", "glint", "factor on the reflection; 0: what is behind the water alone")
