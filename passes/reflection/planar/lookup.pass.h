/* The mirrored render, looked up where the mirror ray of the perturbed normal would be seen in it. */
PASS("Lookup of the mirrored render", "GTA V article, Planar Reflection Map; Water")
#include "slot.h"
#line 202
SPEC(bool, perturb,     true, 0, 1, "1", "GTA V article, Water", "mirror rays about the water's own normals; off: about the plane's")
SPEC(bool, near,        true, 0, 1, "1", "glint; the article says nothing", "rays end at the depth that the map has; off: all that is reflected is infinitely far")
SPEC(int,  refinements, 1,    0, 4, "1", "glint", "times that depth is looked up again where the ray ends")
