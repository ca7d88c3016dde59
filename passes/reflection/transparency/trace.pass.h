/* Composes the half-resolution reflection of the nearest transparent surface over the picture. */
PASS("Traced at half resolution", "Mafia DE article, Transparency and Glows")
#include "slot.h"
#line 202
READ(texture2D, transparent_reflection)
READ(texture2D, transparent_depth_half)
SPEC(bool,  fresnel,    true, 0, 1,    "1", "glint; the article says nothing", "Fresnel reflectance by angle, of both faces of a pane; off: that of normal incidence")
PUSH(float, index,      1.5,  1.0, 4.0, "1", "glint", "refractive index")
PUSH(float, intensity,  1.0,  0.0, 16.0, "1", "glint", "factor on the reflection; 0: only what is behind the surface and on it")
PUSH(float, depth_part, 0.05, 0.0, 10.0, "1", "glint", "half-resolution texels whose depth differs by more than this fraction belong to another surface; 10: no test")
