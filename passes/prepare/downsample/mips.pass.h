/* The variant pick, repeated at half and a quarter of its resolution, with the edges between texels, for sharing reflections at three
   resolutions. A texel of any level is one pixel of the picture, never an average. */
PASS("Three levels with edges", "Mafia DE article, Downscaled Depth and Normals")
#include "slot.h"
#include "jitter.h"
#include "pick_rows.h"
#include "mips_rows.h"
