/* Two blurs for each resolution, horizontal and vertical. No resolution is made of the blur of another one. */
PASS("Separable Gaussian", "Mafia DE article, Post-Processing")
#include "slot.h"
#line 202
WRITE(image2D, bloom_across, RGBA16F, "radiance", HALF_MIPS(4), "R G B A", 0, "bloom_bright, blurred horizontally; a: 1")
READ_OWN(texture2D, across, bloom_across)
DISPATCH_LEVELS(bloom_across, 0, -1, down)
DISPATCH_LEVELS(bloom_blurred, 0, -1, down)
PUSH(float, deviation, 2.0, 0.0, 16.0, "texels", "glint; the article has no value", "standard deviation of the Gaussian in texels of each MIP, 4, 8, 16 and 32 pixels of the picture by default. It ends at three deviations, and the border's texels are repeated beyond it; 0: no blur")
