/* Samples the mirrored render where it shows the end of the perturbed normal's mirror ray. */
PASS("Lookup of the mirrored render", "GTA V article, Planar Reflection Map; Water")
#include "slot.h"
#line 202
SPEC(bool, perturb,     true, 0, 1, "1", "GTA V article, Water", "reflect about the water's own normals; off: about the plane's normal")
SPEC(bool, near,        true, 0, 1, "1", "glint; the article says nothing", "rays end at the depth stored in the map; off: everything reflected is infinitely far away")
SPEC(int,  refinements, 1,    0, 4, "1", "glint", "number of times the depth is sampled again at the new end of the ray")
