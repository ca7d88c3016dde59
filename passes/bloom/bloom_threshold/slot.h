/* What every variant of this slot reads and writes. */
#line 102
SLOT("Light that blooms, at four resolutions")
#include "this_frame/picture_rows.h"
#line 202
WRITE(image2D, bloom_bright, RGBA16F, "radiance", HALF_MIPS(4), "R G B A", 0, "the light of the picture over the threshold, averaged over each texel: MIPs 1 to 4 of the picture. Where the pipeline traces every pixel, the first is as large as the picture. a: 1")
READ_OWN(texture2D, finer_bright, bloom_bright)
DISPATCH_LEVELS(bloom_bright, 0, -1, down)
REFERENCE_NONE("bloom is no light of the scene")
