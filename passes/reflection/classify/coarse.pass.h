/* A list without the tiles of which no ray would be seen. */
PASS("Coarse rejection of tiles", "KF2 article, Final Thoughts (it proposes it)")
#include "slot.h"
#line 202
READ(texture2D, albedo_full)
READ(texture2D, specular_full)
READ(utexture2D, pick)
WRITE(uimage2D, screen_rejected, R8UI, "1", HALF, "rejected", 0, "1 in tiles of which no ray is traced")
DISPATCH(screen_list)
SPEC(bool,  by_view,      true, 0, 1, "1", "KF2 article, Final Thoughts; Viewer Facing Reflections", "reject what runs towards the viewer")
PUSH(float, viewer_to,    0.5,  -1.0, 1.0, "1", "KF2 article, Viewer Facing Reflections", "cosine between ray and view vector from which on nothing is left of a reflection")
PUSH(float, min_reflectance, 0.0,  0.0, 1.0, "1", "glint", "reject surfaces whose reflectance at normal incidence is no more")
PUSH(float, max_roughness,   1.0,  0.0, 1.0, "1", "glint", "reject surfaces that are rougher")
