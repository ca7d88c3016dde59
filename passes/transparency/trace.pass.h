/* Mirror rays of the nearest transparent surface at half resolution, through the opaque picture's depth by the linear march,
   then in the best cube map; laid over the picture at full resolution. */
PASS("Traced at half resolution", "001, Transparency and Glows")
#include "slot.h"
#include "resolve/sources.h"
#include "screen_trace/linear_rows.h"
#line 802
READ(textureCubeArray, cubemap_distance)
SPEC(int,   cubemap_steps, 32, 0, 256,  "steps", "001, Global Illumination; chosen by measuring", "steps through the cube map of a ray that the screen does not show, each longer than the one before; 0: its direction alone is looked up")
SPEC(bool,  fresnel,    true, 0, 1,    "1", "glint; the source says nothing", "reflected share by angle, of both faces of a pane; off: that of vertical incidence")
PUSH(float, index,      1.5,  1.0, 4.0, "1", "glint", "refractive index")
PUSH(float, intensity,  1.0,  0.0, 16.0, "1", "glint", "factor on the reflection; 0: what is behind the surface and on it alone")
PUSH(float, depth_part, 0.05, 0.0, 10.0, "1", "glint", "half-resolution texels whose depth differs by more than this part are of another surface; 10: no such test")
PUSH(float, cubemap_length_m, 100.0, 0.1, 1e6, "m", "glint", "length of those steps")
