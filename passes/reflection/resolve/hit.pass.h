/* One colour at the end of each ray: from the diffuse picture for screen hits, else from the cube maps. */
PASS("Colour at the hit", "Mafia III talk, Color resolve shaders")
#include "slot.h"
OPTIONAL_READ(texture2D, cone_half, R16F, HALF, 0)
OPTIONAL_READ(texture2D, normal_half, RGBA16F, HALF, 0)
#include "ends.h"
#include "sources.h"
REFERENCE
ALONG_RAYS(cubemap_color, normal_jittered)
