/* One colour at the end of each ray: the diffuse picture for screen hits, the cube maps for the others. */
PASS("Colour at the hit", "000, Color resolve shaders")
#include "slot.h"
OPTIONAL_READ(texture2D, cone_half, R16F, HALF, 0)
OPTIONAL_READ(texture2D, ray_numbers, RGBA16F, HALF, 0)
READ(texture2D, normal_half)
#include "ends.h"
#include "sources.h"
#line 302
SPEC(bool,  stratum, true, 0, 1, "1", "glint", "look up all of the stratum that a ray stands for, six places where it ended; off: one place, with its cone")
PUSH(float, threshold, 0.1, 0.001, 0.999, "1", "000, Combining importance sampling with pre-filtering", "lobe value at the rim of a lookup's cone; downsample's must be the same")
REFERENCE
ALONG_RAYS(cubemap_color, normal_jittered)
