/* Picks the nearest surface of a block, and draws a ray from its lobe. */
PASS("Nearest of the block", "Mafia DE article, Transparency and Glows; Stochastic Sampling")
#include "slot.h"
#include "prepare/downsample/jitter.h"
