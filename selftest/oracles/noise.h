/* Numbers without state, for inputs of cases. */
#ifndef GLINT_SELFTEST_NOISE_H
#define GLINT_SELFTEST_NOISE_H

#include <stdint.h>

/* In [0, 1), of nothing but its arguments. */
double noise(uint32_t seed, uint32_t i);

#endif
