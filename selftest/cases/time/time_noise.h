/* Noise of rays, and camera cuts in a whole pipeline: several cases that share their frames. */
#ifndef GLINT_SELFTEST_TIME_NOISE_H
#define GLINT_SELFTEST_TIME_NOISE_H

#include "harness/frames.h"

enum { NOISE_CASES = 5 };
extern const struct glint_selftest_case time_noise[NOISE_CASES];
bool time_noise_run(struct frames *frames, const bool *selected, struct glint_selftest_finding *findings,
                    struct glint_error *err);

#endif
