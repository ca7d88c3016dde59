/* Cases of random.glsl, blue_noise.glsl, bayer.glsl and plus.glsl, whose integers must match exactly. */
#include <stdint.h>

#include "cases/functions/function_case.h"

/* ---- random.glsl ---- */

/* pcg4d as printed in the paper. */
static void pcg4d(uint32_t v[4]) {
    for (int i = 0; i < 4; i++) v[i] = v[i] * 1664525u + 1013904223u;
    v[0] += v[1] * v[3], v[1] += v[2] * v[0], v[2] += v[0] * v[1], v[3] += v[1] * v[2];
    for (int i = 0; i < 4; i++) v[i] ^= v[i] >> 16;
    v[0] += v[1] * v[3], v[1] += v[2] * v[0], v[2] += v[0] * v[1], v[3] += v[1] * v[2];
}
static double open_interval(uint32_t word) {
    return ((double)(word / 512) + 0.5) / 8388608;
}
static void expect_random(const double *x, double *y) {
    uint32_t v[4];
    for (int i = 0; i < 4; i++) v[i] = (uint32_t)x[i];
    pcg4d(v);
    for (int i = 0; i < 4; i++) y[i] = open_interval(v[i]);
}
/* Integers of 32 bits are passed as two floats. */
static uint32_t whole(const double *x) {
    return (uint32_t)x[0] << 16 | (uint32_t)x[1];
}
static void halves(uint32_t word, double *y) {
    y[0] = word >> 16;
    y[1] = word & 0xFFFF;
}
static void expect_hash(const double *x, double *y) {
    uint32_t v[4] = {whole(x), whole(x + 2), whole(x + 4), whole(x + 6)};
    pcg4d(v);
    halves(v[0] ^ v[1], y);
    halves(v[2] ^ v[3], y + 2);
}
static void expect_frame_number(const double *x, double *y) {
    (void)x;
    halves(1, y); /* the frame number of this run, whose first ray adds 0 */
}

/* ---- blue_noise.glsl ---- */

/* Radical inverse in base 2, and the Gray-code construction of Sobol's second dimension: Pascal's triangle modulo 2. */
static void sobol(uint32_t index, double y[2]) {
    y[0] = y[1] = 0;
    for (int row = 0; row < 32; row++) {
        unsigned bit = 0;
        for (int column = row; column < 32; column++) /* C(column, row) is odd when row's bits are among column's */
            bit ^= (index >> column & 1) & ((row & column) == row);
        y[0] += ldexp(index >> row & 1, -1 - row);
        y[1] += ldexp(bit, -1 - row);
    }
}
static void expect_sobol(const double *x, double *y) {
    sobol((uint32_t)x[0], y);
}
static void expect_spread_bits(const double *x, double *y) {
    uint32_t word = 0;
    for (int bit = 0; bit < 16; bit++) word |= ((uint32_t)x[0] >> bit & 1) << 2 * bit;
    halves(word, y);
}
static uint32_t reversed(uint32_t v) {
    uint32_t r = 0;
    for (int bit = 0; bit < 32; bit++) r |= (v >> bit & 1) << (31 - bit);
    return r;
}
/* Burley's listing with N. Vegdahl's constants. */
static uint32_t owen(uint32_t v, uint32_t seed) {
    v = reversed(v);
    v ^= v * 0x3D20ADEAu;
    v += seed;
    v *= (seed >> 16) | 1;
    v ^= v * 0x05526C56u;
    v ^= v * 0x53A22864u;
    return reversed(v);
}
static void expect_owen(const double *x, double *y) {
    halves(owen(whole(x), whole(x + 2)), y);
}
/* The defining property of Owen scrambling: two scrambled numbers agree up to the first bit in which the numbers differ, and differ there. */
static void expect_first_bit(const double *x, double *y) {
    y[0] = y[1] = 31 - x[4];
}
/* Each digit, from the highest down, is permuted by a hash of the digits above it (Fisher and Yates). */
static uint32_t shuffled(uint32_t index, uint32_t seed) {
    uint32_t result = 0;
    for (int digit = 15; digit >= 0; digit--) {
        uint32_t word[4] = {digit == 15 ? 0 : index >> 2 * (digit + 1), 2 * (uint32_t)digit, seed, 0x5A0B};
        uint32_t order[4] = {0, 1, 2, 3};
        pcg4d(word);
        for (uint32_t i = 0; i < 3; i++) {
            const uint32_t other = i + (word[i] >> 8) % (4 - i), kept = order[i];
            order[i] = order[other];
            order[other] = kept;
        }
        result |= order[index >> 2 * digit & 3] << 2 * digit;
    }
    return result;
}
static void expect_shuffled(const double *x, double *y) {
    halves(shuffled(whole(x), whole(x + 2)), y);
}
static void expect_ray_points(const double *x, double *y) {
    const uint32_t ray = whole(x + 4);
    uint32_t seed[4] = {(uint32_t)x[0], (uint32_t)x[1], whole(x + 2), 0x50B0 + (ray >> 20)};
    double point[2];
    pcg4d(seed);
    sobol(ray & 0xFFFFF, point);
    for (int k = 0; k < 2; k++) y[k] = open_interval(owen((uint32_t)ldexp(point[k], 32), seed[k]));
}
static void expect_blue_noise(const double *x, double *y) {
    const uint32_t frame = whole(x + 2), ray = (uint32_t)x[4];
    uint32_t seed[4] = {frame / 16, ray, 0xB1, 0}, shift[4] = {frame, ray, 0xB1, 1}, place = 0;
    double point[2], turn[2];
    pcg4d(seed), pcg4d(shift);
    for (int bit = 0; bit < 16; bit++)
        place |= ((uint32_t)x[0] >> bit & 1) << 2 * bit | ((uint32_t)x[1] >> bit & 1) << (2 * bit + 1);
    sobol(shuffled(place, seed[0]), point);
    sobol(frame % 16, turn);
    for (int k = 0; k < 2; k++)
        y[k] = open_interval(owen((uint32_t)ldexp(point[k], 32), seed[1 + k]) ^ (uint32_t)ldexp(turn[k], 32) ^
                             shift[k] / 16);
}

/* ---- bayer.glsl, plus.glsl ---- */

/* The recursive definition: a quarter of the 2x2 matrix [0 2; 3 1] inside four times itself. */
static void expect_bayer(const double *x, double *y) {
    static const int cell[2][2] = {{0, 2}, {3, 1}};
    const int px = (int)x[0], py = (int)x[1];
    y[0] = (4 * cell[py & 1][px & 1] + cell[py >> 1 & 1][px >> 1 & 1]) / 16.0;
}
static void expect_plus(const double *x, double *y) {
    y[0] = fmod(x[0] + 2 * x[1] + x[2], 5);
}

static void expect_strata(const double *x, double *y) {
    const double major = fmod(x[0] + 2 * x[1] + x[2], 5), minor = fmod(x[0] + floor(x[2] / 5), 5);
    y[0] = (fmod(2 * major + minor, 5) + x[3]) / 5;
    y[1] = (major + x[4]) / 5;
}

/* clang-format off */
#define WORD {WHOLE, 0, 65535, 0}, {WHOLE, 0, 65535, 0}
#define AB "uint(a.x) << 16u | uint(a.y)"
#define CD "uint(a.z) << 16u | uint(a.w)"
#define EF "uint(b.x) << 16u | uint(b.y)"
#define GH "uint(b.z) << 16u | uint(b.w)"
#define INTEGERS "integers, and a conversion that is exact"

static const struct function list[] = {
    {"random numbers", "the exact bits of the hash, for each pixel and frame", "random4(uvec2(a.xy), uint(a.z), uint(a.w))", "x y frame dimension",
     {{WHOLE, 0, 16384, 0}, {WHOLE, 0, 16384, 0}, {WHOLE, 0, 16777215, 0}, {WHOLE, 0, 4096, 0}}, NULL, expect_random, 4, ABSOLUTE, 0, INTEGERS},
    {"hash", "of four words up to 4294967295", "words(hash4(uvec4(" AB ", " CD ", " EF ", " GH ")))", "x x' y y' z z' w w'", {WORD, WORD, WORD, WORD}, NULL, expect_hash, 4, ABSOLUTE, 0, "integers"},
    {"number of a frame", "the frame number that seeds random numbers", "float(random_frame() >> 16u), float(random_frame() & 0xFFFFu), 0.0, 0.0", "any", {{LINEAR, 0, 1, 0}}, NULL, expect_frame_number, 2, ABSOLUTE, 0, "integers"},
    {"low-discrepancy points", "Sobol's first two dimensions", "vec2(sobol2(uint(a.x)) >> 8u) / 16777216.0, 0.0, 0.0", "index", {{WHOLE, 0, 16777215, 0}}, NULL,
     expect_sobol, 2, ABSOLUTE, 0, "24 bits fit a float"},
    {"spread bits", "Z-order's bits two places apart, of 16", "float(spread_bits(uint(a.x)) >> 16u), float(spread_bits(uint(a.x)) & 0xFFFFu), 0.0, 0.0", "x", {{WHOLE, 0, 65535, 0}}, NULL, expect_spread_bits, 2, ABSOLUTE, 0, "integers"},
    {"Owen's scrambling", "any number by any seed", "words(uvec4(owen_scramble(" AB ", " CD "), 0u, 0u, 0u)).xy, 0.0, 0.0", "x x' seed seed'", {WORD, WORD}, NULL, expect_owen, 2, ABSOLUTE, 0, "integers"},
    {"Owen's scrambling is one", "numbers whose highest differing bit is n are mapped to numbers whose highest differing bit is n", "float(findMSB(owen_scramble(" AB ", " CD ") ^ owen_scramble((" AB ") ^ 1u << 31u - uint(b.x), " CD "))), "
     "float(findMSB(owen_scramble(" AB ", " CD ") ^ owen_scramble((" AB ") ^ (2u << 31u - uint(b.x)) - 1u, " CD "))), 0.0, 0.0", "x x' seed seed' bit", {WORD, WORD, {WHOLE, 0, 31, 0}}, NULL, expect_first_bit, 2, ABSOLUTE, 0, "integers"},
    {"shuffled digits", "base-4 digits by those above, any number by any seed", "words(uvec4(shuffle_digits(" AB ", " CD "), 0u, 0u, 0u)).xy, 0.0, 0.0", "x x' seed seed'", {WORD, WORD}, NULL, expect_shuffled, 2, ABSOLUTE, 0, "integers"},
    {"points of rays", "the sequence of a pixel, scrambled again after 2^20 rays", "ray_points2(uvec2(a.xy), " CD ", " EF "), 0.0, 0.0", "x y frame frame' ray ray'", {{WHOLE, 0, 16384, 0}, {WHOLE, 0, 16384, 0}, WORD, WORD}, NULL, expect_ray_points, 2, ABSOLUTE, 0, INTEGERS},
    {"blue noise", "points along a shuffled Z-order, for different frames and rays", "blue_noise2(uvec2(a.xy), " CD ", uint(b.x)), 0.0, 0.0", "x y frame frame' ray", {{WHOLE, 0, 65535, 0}, {WHOLE, 0, 65535, 0}, WORD, {WHOLE, 0, 65535, 0}}, NULL, expect_blue_noise, 2, ABSOLUTE, 0, INTEGERS},
    {"ordered dither", "the Bayer matrix, compared with its recursive definition", "bayer4(ivec2(a.xy)), 0.0, 0.0, 0.0", "x y", {{WHOLE, 0, 16384, 0}, {WHOLE, 0, 16384, 0}}, NULL, expect_bayer, 1, ABSOLUTE, 0, "sixteenths"},
    {"plus pattern", "classes of pixels, large frame numbers too", "float(plus_class(uvec2(a.xy), uint(a.z)))", "x y shift",
     {{WHOLE, 0, 16384, 0}, {WHOLE, 0, 16384, 0}, {WHOLE, 0, 16777215, 0}}, NULL, expect_plus, 1, ABSOLUTE, 0, "integers"},
    {"strata of pluses", "a cell of 5 x 5 for each of 25 pixels", "plus_strata(uvec2(a.xy), uint(a.z), vec2(a.w, b.x)), 0.0, 0.0", "x y shift u v",
     {{WHOLE, 0, 16384, 0}, {WHOLE, 0, 16384, 0}, {WHOLE, 0, 16777215, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}}, NULL, expect_strata, 2, ABSOLUTE, 2.4e-7, "two roundings of numbers below 5"},
};
/* clang-format on */

const struct function_list functions_patterns = {list, sizeof list / sizeof *list};
