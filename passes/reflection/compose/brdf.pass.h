/* Reflection weighted by the environment BRDF, over the diffuse picture. */
PASS("Environment BRDF", "000, Combined BRDF; split sum of Karis 2013")
#include "slot.h"
WORKGROUP(8, 16)
SPEC(bool,  fresnel,   true, 0, 1, "1", "glint", "weigh by the environment BRDF; off: by the reflectance at normal incidence alone")
PUSH(float, intensity, 1.0,  0.0, 16.0, "1", "glint", "factor on the reflection; 0: lit alone")
REFERENCE
