/* Down a chain of the farthest distance, up again with a weighted maximum. */
PASS("Weighted maximum", "000, Generating cocoon MIP")
#include "slot.h"
WORKGROUP(8, 16)
#line 202
SELF(textureCubeArray, chain, cocoon_distance)
SELF(texture2DArray, faces, cocoon_distance)
FACT(cube_sky)
SPEC(int,   size,       32,  1,     4096,  "texels", "000, Cocoon cube-map depth MIP", "width of the level that becomes the cocoon: the widest that is no wider")
SPEC(int,   reach,      3,   0,     16,    "taps", "000, Weighted MAX (samples not printed)", "taps are the lattice points up to this far: 3: 29 taps")
CHOICE2(maximum, pairs, pairs, samples, "000, Weighted MAX; pairs: glint, chosen by measuring", "of the means of two samples on either side, which leaves planes where they are; or of each, as in the slides")
SPEC(bool,  cap_sky,    true, 0,    1,     "1", "000, Generating cocoon MIP, upper MIPs", "finer levels take the cocoon where they see sky; off: they stay +inf there")
PUSH(float, kernel,     3.5, 0.25,  64.0,  "texels", "000, Weighted MAX (specPow not printed)", "radius of the kernel, in texels of the coarser level that it reads")
PUSH(float, threshold,  0.1, 0.001, 0.999, "1", "000, Weighted MAX (specPow not printed)", "weight there, from which the power follows")
DISPATCH_LEVELS(cocoon_distance, 1, -1, down)
DISPATCH_LEVELS_BY(cocoon_distance, size, 0, 31, up)
DISPATCH_LEVELS_BY(cocoon_distance, size, -31, -1, up)
DISPATCH(cocoon)
