/* Builds the list without the tiles in which no reflection would be visible. */
PASS("Coarse rejection of tiles", "KF2 article, Final Thoughts (it proposes this)")
#include "slot.h"
WORKGROUP(16, 16)
#line 202
READ(texture2D, albedo_full)
READ(texture2D, specular_full)
READ(utexture2D, pick)
WRITE(uimage2D, screen_rejected, R8UI, "1", HALF, "rejected", 0, "1 in tiles where no ray is traced")
READ_OWN(utexture2D, rejected, screen_rejected)
READ_OWN(utextureBuffer, marked, screen_list)
DISPATCH(screen_rejected)
DISPATCH(screen_list)
DISPATCH(screen_list)
SPEC(bool,  by_view,      true, 0, 1, "1", "KF2 article, Final Thoughts; Viewer Facing Reflections", "reject rays that run towards the viewer")
PUSH(float, viewer_to,    0.5,  -1.0, 1.0, "1", "KF2 article, Viewer Facing Reflections", "cosine between ray and view vector above which a reflection has faded out")
PUSH(float, min_reflectance, 0.0,  0.0, 1.0, "1", "glint", "reject surfaces whose reflectance at normal incidence is at most this")
PUSH(float, max_roughness,   1.0,  0.0, 1.0, "1", "glint", "reject surfaces rougher than this")
