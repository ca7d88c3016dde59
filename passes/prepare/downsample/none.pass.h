/* The G-buffer as it is: rays for every pixel. The pipeline's half resolution becomes the full one. */
PASS("Full resolution", "Mafia III talk, G-buffer down-sampling (what it saves)")
RESOLUTION(full)
#include "slot.h"
#include "jitter.h"
REFERENCE
REFERENCE_SET(downsample, pattern, sobol)
ALONG_RAYS(normal_jittered, normal_full)
