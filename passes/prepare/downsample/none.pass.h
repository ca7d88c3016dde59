/* The G-buffer as it is: one ray or more per pixel. The pipeline's half resolution becomes full resolution. */
PASS("Full resolution", "Mafia III talk, G-buffer down-sampling (its absence)")
RESOLUTION(full)
#include "slot.h"
#include "jitter.h"
REFERENCE
REFERENCE_SET(downsample, pattern, sobol)
ALONG_RAYS(normal_jittered, normal_full)
