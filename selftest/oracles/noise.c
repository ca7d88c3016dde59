#include "oracles/noise.h"

double noise(uint32_t seed, uint32_t i) {
    uint64_t x = ((uint64_t)seed << 32 | i) + 0x9E3779B97F4A7C15u; /* splitmix64 */
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return (double)((x ^ x >> 31) >> 11) * 0x1p-53;
}
