/* Cases of stable.glsl, steps.glsl, cone.glsl, fog.glsl and froxels.glsl. */
#include "cases/functions/function_case.h"

/* Tolerances of base-2 exponentials and logarithms and of functions that use them, conversion to base e included. */
#define EXP "exp is 3 + 2|x| ULP off (Vulkan)"
#define LOGARITHM "log is 3 ULP off, between 0.5 and 2 absolute 2^-21 (Vulkan)"

/* ---- stable.glsl ---- */

static void expect_expm1(const double *x, double *y) {
    y[0] = expm1(x[0]);
}
static void expect_expm1_below(const double *x, double *y) {
    y[0] = expm1(-x[0]);
}
/* For small x, e^x - 1 cancels even in double precision: sums the series, smallest terms first. */
static void expect_expm1_rest(const double *x, double *y) {
    y[0] = 1;
    for (int k = 30; k > 2; k--) y[0] = 1 + x[0] / k * y[0];
    y[0] *= x[0] * x[0] / 2;
}
static void expect_rests(const double *x, double *y) {
    const double below = -2 * x[0];
    expect_expm1_rest(x, &y[0]);
    expect_expm1_rest(&below, &y[1]);
}
static void expect_log1p(const double *x, double *y) {
    y[0] = log1p(x[0]);
}
static void below_one(float *x) {
    x[0] = -x[0];
}
static void sine_and_cosine(float *x) {
    const double angle = (double)x[0];
    x[0] = (float)sin(angle);
    x[1] = (float)cos(angle);
}
static void expect_arc(const double *x, double *y) {
    y[0] = atan2(x[0], x[1]);
}
static void expect_angle_from_versine(const double *x, double *y) {
    y[0] = 2 * asin(sqrt(x[0] / 2));
}
static void expect_versine(const double *x, double *y) {
    y[0] = 2 * pow(sin(x[0] / 2), 2);
}
static void expect_tangent(const double *x, double *y) {
    y[0] = tan(x[0]);
}
static void vector_of_any_length(float *x) {
    const float size = x[3];
    for (int k = 0; k < 3; k++) x[k] *= size;
}
static void expect_unit(const double *x, double *y) {
    const double most = fmax(fabs(x[0]), fmax(fabs(x[1]), fabs(x[2])));
    const double v[3] = {x[0] / most, x[1] / most, x[2] / most}, l = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) y[k] = v[k] / l;
}
/* Rounds to half: steps of 2^-10 relative to the power of two below, of 2^-24 for values below 2^-14; at most 65504. */
static void expect_nearest_half(const double *x, double *y) {
    int exponent;
    for (int k = 0; k < 4; k++) {
        frexp(x[k], &exponent);
        const double apart = ldexp(1, exponent < -13 ? -24 : exponent - 11);
        y[k] = fabs(x[k]) < 65504 ? apart * nearbyint(x[k] / apart) : x[k]; /* ties to even */
    }
}
static void ties_of_halves(float *x) {
    x[2] = (float)(1024 + floor((double)x[2])) + 0.5f; /* halfway between two halves */
    if (x[3] < 0) x[3] = NAN;
}
static void expect_finite(const double *x, double *y) {
    y[0] = isfinite(x[0]) && fabs(x[0]) < 3e38;
}
static void expect_storable(const double *x, double *y) {
    for (int k = 0; k < 3; k++) y[k] = x[k] > x[3] ? x[3] : x[k]; /* NaN stays NaN */
}
static void one_nan(float *x) {
    if (x[2] < 0) x[2] = NAN;
}
static void sometimes_nan(float *x) {
    if (x[1] > 0.5f) x[0] = NAN;
}

/* ---- steps.glsl ---- */

/* The sum of `count` steps with ratio 1 + d and first step 1. */
static double series(double d, double count) {
    return d == 0 ? count : expm1(count * log1p(d)) / d;
}
static void one_and_more(float *x) {
    x[1] = (float)(1 + (double)x[1]);
}
static void expect_first_step(const double *x, double *y) {
    y[0] = x[0] / series(x[1] - 1, x[2]);
}
static void sum_near_count(float *x) {
    x[0] = (float)((double)x[1] * (1 + (double)x[0]));
}
/* The device's ratio is checked by the sum that it yields. */
static void expect_ratio(const double *x, double *y) {
    double low = -1, high = 1;
    while (series(high, x[1]) < x[0]) high *= 2;
    for (int i = 0; i < 200; i++) {
        const double middle = 0.5 * (low + high);
        if (series(middle, x[1]) < x[0]) low = middle;
        else high = middle;
    }
    y[0] = 1 + low;
}

/* ---- cone.glsl ---- */

static double tangent(double angle) {
    return tan(fmin(angle, (double)1.57f)); /* the shader's limit is a float */
}
static void expect_cone_tangent(const double *x, double *y) {
    y[0] = tangent(x[0]);
}
static void expect_tangent_of_level(const double *x, double *y) {
    y[0] = exp2(x[0]) * x[2] / (x[1] / 2);
}
static void expect_cone_power(const double *x, double *y) {
    y[0] = -2 * log(x[1]) / log1p(x[0] * x[0]);
}
static double level(double texels, double most) {
    return texels > 1 ? log2(fmin(texels, most)) : 0;
}
static void expect_level_cube(const double *x, double *y) {
    const double spread = isinf(x[1]) ? 1 : x[1] == 0 ? 0 : fmin(x[1] / fmax(x[2], 1e-12), 1e12);
    y[0] = level(spread == 0 ? 0 : tangent(x[0]) * spread * x[3] / 2 / 3.5, x[3]);
}
static void expect_level_screen(const double *x, double *y) {
    const double spread = x[1] == 0 ? 0 : fmin(x[1] / fmax(x[2], 1e-12), 1e12);
    y[0] = level(spread == 0 || x[0] == 0 ? 0 : tangent(x[0]) * spread * x[3] / 3.5, exp2(x[4]));
}

/* ---- fog.glsl ---- */

static double fog(double height, double slope, double length) {
    const double climb = slope / 5, start = 0.02 * exp(-height / 5);
    if (isinf(length)) return climb > 0 ? start / climb : (double)3.0e38f;
    return climb == 0 ? start * length : start * -expm1(-climb * length) / climb;
}
static void expect_fog(const double *x, double *y) {
    y[0] = fog(x[0], x[1], x[2]);
}
static void expect_fog_endless(const double *x, double *y) {
    y[0] = fog(x[0], x[1], INFINITY);
}
static void expect_fog_factor(const double *x, double *y) {
    y[0] = -expm1(-x[0]);
}
static void expect_even_fog(const double *x, double *y) {
    y[0] = x[0] <= 0 || x[1] <= 0 ? 0 : x[0] * x[1];
}

static void to_beyond(float *x) {
    x[1] += x[0];
}
static void expect_mean_passing(const double *x, double *y) {
    const double more = x[1] - x[0];
    y[0] = exp(-x[0]) * (isinf(more) ? 0 : more > 0 ? -expm1(-more) / more : 1);
}
static void expect_even_slice(const double *x, double *y) {
    y[0] = x[2] + (x[2] + x[3] - x[2]) * x[0] / x[1];
}
static void expect_growing_slice(const double *x, double *y) {
    y[0] = x[2] * pow(x[3], x[0] / x[1]);
}

static void expect_half_range(const double *x, double *y) {
    y[0] = isfinite(x[0]) ? fmin(fmax(x[0], -65504), 65504) : x[0];
    y[1] = x[0];
}

/* clang-format off */
static const struct function list[] = {
    {"expm1 near zero", "e^x - 1 keeps its digits where e^x is near 1", "expm1(a.x)", "x", {{LOG, 1e-30, 1, ZERO | NEGATIVE}}, NULL,
     expect_expm1, 1, ULP, 12, EXP ", of which 2.4 times as much is left where the series ends, at -0.35"},
    {"expm1 far from zero", "e^x - 1 for large exponents", "expm1(a.x)", "x", {{LINEAR, 1, 80, 0}}, NULL,
     expect_expm1, 1, ULP, 165, EXP ": 163 at 80"},
    {"expm1 far below zero", "e^x - 1 tends to -1", "expm1(-a.x)", "-x", {{LOG, 1, 1e30, ENDLESS}}, NULL,
     expect_expm1_below, 1, ULP, 6, EXP ": below 0.4 of an ULP of the result's 0.6 at -1, and less farther down"},
    {"expm1 beyond its tangent", "e^x - 1 - x, of which next to nothing is left near zero", "expm1_rest(a.x), expm1_rest(-2.0 * a.x), 0.0, 0.0", "x", {{LOG, 1e-15, 1, ZERO}}, NULL,
     expect_rests, 2, ULP, 16, "thirteen divisions, 2.5 ULP each (Vulkan), but what the k-th leaves shrinks with 2/k: 2/3 of the first, 1/3 of the second, and roundings"},
    {"log1p near zero", "log(1 + x) keeps its digits where 1 + x does not", "log1p(a.x)", "x", {{LOG, 1e-30, 0.5, ZERO | NEGATIVE}}, NULL,
     expect_log1p, 1, ULP, 6, "two divisions, 2.5 ULP each (Vulkan), and roundings that shrink with the series"},
    {"log1p far from zero", "log(1 + x) of large arguments", "log1p(a.x)", "x", {{LOG, 0.5, 1e30, 0}}, NULL,
     expect_log1p, 1, ULP, 18, LOGARITHM ": 16 ULP of log 1.5"},
    {"log1p near its pole", "log(1 + x) as x nears -1", "log1p(a.x)", "x", {{LINEAR, 0.5, 0.99999994, 0}}, below_one,
     expect_log1p, 1, ULP, 10, LOGARITHM ": 8 ULP of log 0.5"},
    {"arc", "angle from sine and cosine, 0 to a right angle", "arc(a.x, a.y)", "sine cosine", {{LOG, 1e-30, 1.57079632, ZERO}}, sine_and_cosine,
     expect_arc, 1, ULP, 8, "three halvings with a root and a division each, 2.5 ULP (Vulkan) of a number near 1"},
    {"angle from versine", "acos(1 - q) where 1 - q is rounded to 1", "angle_from_versine(a.x)", "q", {{LOG, 1e-37, 1, ZERO}}, NULL,
     expect_angle_from_versine, 1, ULP, 10, "arc's, and the sine's root"},
    {"versine", "1 - cos of tiny angles up to a right one", "versine(a.x)", "angle", {{LOG, 1e-18, 1.5707963, ZERO}}, NULL,
     expect_versine, 1, ULP, 4, "a product of sums that the first term rules"},
    {"tangent", "of angles up to next to a right one", "tangent(a.x)", "angle", {{LOG, 1e-30, 1.57, ZERO}}, NULL,
     expect_tangent, 1, ULP, 8, "a quotient of polynomials and its inverse, 2.5 ULP each (Vulkan)"},
    {"unit vectors", "of vectors as short and as long as floats are", "unit(a.xyz), 0.0", "x y z length",
     {{LOG, 1e-3, 1, ZERO | NEGATIVE}, {LOG, 1e-3, 1, NEGATIVE}, {LINEAR, 0.1, 1, 0}, {LOG, 1e-35, 3e38, 0}}, vector_of_any_length,
     expect_unit, 3, ABSOLUTE, 5e-7, "a division, 2.5 ULP, an inverse root, 2 ULP (Vulkan), of numbers up to 1"},
    {"storable colours", "held at the largest that an image holds, infinite ones too; NaN stays", "storable(a.xyz, a.w), 0.0", "r g b largest",
     {{LOG, 1e-3, 1e6, ZERO | ENDLESS | NEGATIVE}, {LOG, 65000, 66000, ENDLESS}, {LINEAR, -1, 1e5, 0}, {LOG, 65504, 1e5, ENDLESS}}, one_nan,
     expect_storable, 3, ABSOLUTE, 0, "a decision"},
    {"range of halves", "what is stored into an image of halves: finite numbers held at the largest, infinite ones as they are; others unchanged", "half_range(vec4(a.x)).x, in_range(vec4(a.x), false).x, 0.0, 0.0", "x",
     {{LOG, 1e-3, 3.39e38, ZERO | ENDLESS | NEGATIVE}}, NULL, expect_half_range, 2, ABSOLUTE, 0, "a decision"},
    {"nearest half", "what an image of halves holds, ties to even, small and huge ones too", "nearest_half(a)", "x y tie z",
     {{LOG, 1e-9, 1e6, ZERO | ENDLESS | NEGATIVE}, {LOG, 3e-8, 3e-4, NEGATIVE}, {LINEAR, 0, 1023, 0}, {LOG, 65000, 66000, ENDLESS | NEGATIVE}}, ties_of_halves,
     expect_nearest_half, 4, ABSOLUTE, 0, "exact"},
    {"finite colours", "which values may take part in a mean", "finite(vec4(0.0, a.x, 0.0, 1.0))", "x nan",
     {{LOG, 1e-38, 3.39e38, ZERO | ENDLESS | NEGATIVE}, {LINEAR, 0, 1, 0}}, sometimes_nan, expect_finite, 1, ABSOLUTE, 0, "a decision"},

    {"first step", "first of geometric steps that sum to a length, ratio to 1 from both sides", "geometric_first_step(a.x, a.y, int(a.z))", "total ratio count",
     {{LOG, 0.1, 1e6, 0}, {LOG, 1e-7, 0.3, ZERO | NEGATIVE}, {WHOLE, 1, 64, 0}}, one_and_more,
     expect_first_step, 1, ULP, 130, "the exponent, up to 23, carries its rounding: 3 + 2|x| ULP of exp and 6|x| of the logarithm in it"},
    {"ratio of steps", "ratio with which steps sum to a multiple of the first", "geometric_ratio(a.x, int(a.y))", "sum count",
     {{LOG, 1.001, 1e6, 0}, {WHOLE, 2, 256, 0}}, NULL, expect_ratio, 1, ULP, 40, "log of the sum, 3 ULP of up to 14, over the count and more where that is 2"},
    {"ratio of steps near one", "the same where sum and count are all but equal", "geometric_ratio(a.x, int(a.y))", "sum count",
     {{LOG, 1e-7, 1e-2, ZERO | NEGATIVE}, {WHOLE, 2, 256, 0}}, sum_near_count, expect_ratio, 1, ULP, 24, "log of the sum, 3 ULP of up to 5.5, twice over the count less one"},

    {"cone radius", "tangent of a cone, from 0 to a right angle and past it", "cone_tangent(a.x)", "angle", {{LOG, 1e-30, 1.5707964, ZERO}}, NULL,
     expect_cone_tangent, 1, ULP, 8, "a quotient of polynomials and its inverse, 2.5 ULP each (Vulkan)"},
    {"cone of a level", "tangent of the cone that a MIP level represents", "cone_tangent_of_level(a.x, a.y, a.z)", "level size scale",
     {{LINEAR, 0, 12, 0}, {LOG, 1, 4096, 0}, {LINEAR, 0.5, 8, 0}}, NULL, expect_tangent_of_level, 1, ULP, 33, EXP ": 27 at level 12, and a division"},
    {"power of a cone", "power from angle, from the narrowest to the widest", "cone_power(a.x, a.y)", "tangent threshold",
     {{LOG, 1e-17, 1255, 0}, {LINEAR, 0.01, 0.5, 0}}, NULL, expect_cone_power, 1, ULP, 30, LOGARITHM ", twice, and a division"},
    {"level of a cube map", "level at the end of a ray: at the centre, at the surface, infinitely far", "cone_level_cube(a.x, a.y, a.z, a.w, 3.5)", "angle travelled from_centre size",
     {{LOG, 1e-6, 1.5707964, ZERO}, {LOG, 1e-6, 1e6, ZERO | ENDLESS}, {LOG, 1e-6, 1e6, ZERO}, {LOG, 1, 2048, 0}}, NULL,
     expect_level_cube, 1, ABSOLUTE, 8e-6, "log2 is 3 ULP off (Vulkan), 2.9e-6 of 11; its argument's 12 ULP are 1e-6 levels"},
    {"level of the screen", "as for cube maps, in the MIP chain of the picture", "cone_level_screen(a.x, a.y, a.z, a.w, 3.5, b.x)", "angle travelled depth pixels last",
     {{LOG, 1e-6, 1.5707964, ZERO}, {LOG, 1e-6, 1e6, ZERO | ENDLESS}, {LOG, 1e-6, 1e6, ZERO}, {LOG, 10, 4000, 0}, {WHOLE, 0, 11, 0}}, NULL,
     expect_level_screen, 1, ABSOLUTE, 8e-6, "as for cube maps"},

    {"fog along a ray", "optical depth of ascending, level and descending rays", "fog_optical_depth(0.02, a.x, a.y, 5.0, a.z)", "height slope length",
     {{LINEAR, -20, 60, 0}, {LOG, 1e-9, 1, ZERO | NEGATIVE}, {LOG, 1e-3, 60, 0}}, NULL, expect_fog, 1, ULP, 70, EXP " twice, of up to 12"},
    {"fog without end", "optical depth to infinity, opaque for descending rays", "fog_optical_depth(0.02, a.x, a.y, 5.0, INFINITE)", "height slope",
     {{LINEAR, -20, 60, 0}, {LOG, 1e-9, 1, ZERO | NEGATIVE}}, NULL, expect_fog_endless, 1, ULP, 36, EXP ", of up to 12, and a division"},
    {"even fog", "optical depth of uniform fog; 0 without fog or length", "fog_optical_depth(a.x, 1.0, 1.0, 0.0, a.y)", "density length",
     {{LOG, 1e-6, 1, ZERO}, {LOG, 1e-3, 1e6, ZERO | NEGATIVE}}, NULL, expect_even_fog, 1, ULP, 1, "one product"},
    {"fog factor", "fraction of the light that fog absorbs, thin to opaque", "fog_factor(a.x)", "depth", {{LOG, 1e-30, 1e30, ZERO | ENDLESS}}, NULL,
     expect_fog_factor, 1, ULP, 12, EXP ", of which 2.4 times as much is left where the series ends"},
    {"mean of what passes", "mean of what fog lets through along a stretch, thin to opaque", "fog_mean_passing(a.x, a.y)", "from to",
     {{LOG, 1e-6, 8, ZERO}, {LOG, 1e-30, 1e30, ZERO | ENDLESS}}, to_beyond, expect_mean_passing, 1, ULP, 36, EXP ", 19 at 8, 12 of expm1, a division and products"},
    {"even slices", "where each of the slices of light in the air begins", "froxel_depth(int(a.x), uint(a.y), vec4(a.z, a.z + a.w, 0.0, 0.0))", "slice slices near thickness",
     {{WHOLE, 0, 84, 0}, {WHOLE, 84, 1024, 0}, {LOG, 1e-3, 10, ZERO}, {LOG, 1, 1e4, 0}}, NULL, expect_even_slice, 1, ULP, 6, "a division (2.5), sums and products of positive numbers"},
    {"growing slices", "the same, each so many times as thick as the one before", "froxel_depth(int(a.x), uint(a.y), vec4(a.z, a.z * a.w, 1.0, 0.0))", "slice slices near ratio",
     {{WHOLE, 0, 84, 0}, {WHOLE, 84, 1024, 0}, {LOG, 1e-3, 10, 0}, {LOG, 1.001, 1e4, 0}}, NULL, expect_growing_slice, 1, ULP, 80, "pow is that of exp2 at up to 13.3 (30 ULP) and of log2 in it (3 ULP, 28 of the power), of a quotient that is 3 ULP off"},
};
/* clang-format on */

const struct function_list functions_elementary = {list, sizeof list / sizeof *list};
