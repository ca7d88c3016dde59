/* Adds the reflection, weighted by the environment BRDF, to the diffuse picture with the terms of other effects. */
PASS("Environment BRDF", "Mafia III talk, Combined BRDF; Karis 2013 (split sum)")
#include "slot.h"
WORKGROUP(8, 16)
SPEC(bool,  fresnel,   true, 0, 1, "1", "glint", "weight by the environment BRDF; off: by the reflectance at normal incidence only")
PUSH(float, intensity, 1.0,  0.0, 16.0, "1", "glint", "factor on the reflection; 0: none")
REFERENCE
