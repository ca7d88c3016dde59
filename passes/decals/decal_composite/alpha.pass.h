/* captured + alpha · (decal - captured), with a factor for each decal buffer; where it is 0 every bit stays. */
PASS("Blended by alpha", "Mafia DE article, Stencil Composite")
#include "slot.h"
#line 202
REFERENCE_NONE("the truths of a capture are of the G-buffer that it has")
SPEC(bool,  stencil,   true, 0, 1, "1", "Mafia DE article, Stencil Composite", "only pixels of the stencil class `decal` change, where the capture has that class; off: alpha alone says which")
SPEC(bool,  albedo,    true, 0, 1, "1", "Mafia DE article, Stencil Composite", "blend base colours; off: they stay")
SPEC(bool,  normals,   true, 0, 1, "1", "Mafia DE article, Stencil Composite", "blend normals, which become unit vectors again; off: they stay")
SPEC(bool,  material,  true, 0, 1, "1", "Mafia DE article, GBuffer Pass", "blend roughness and specular; off: they stay")
PUSH(float, strength,  1.0, 0.0, 1.0, "1", "glint", "factor on alpha; 0: no decals")
