/* Random numbers for tests on the host. */
#ifndef GLINT_TESTS_UNIFORM_H
#define GLINT_TESTS_UNIFORM_H

#include <stdint.h>

/* The next random number in [0, 1) of a linear congruential generator. */
static inline double uniform(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

#endif
