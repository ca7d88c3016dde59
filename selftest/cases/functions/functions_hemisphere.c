/* Cases of hemisphere.glsl. */
#include "cases/functions/function_case.h"

/* ∫ |sin θ| cos(θ - γ) dθ over the elevations from the tangent plane to e, by Simpson's rule: 3·10⁻⁹ off over half a turn. */
static double slice(double e, double gamma) {
    enum { PARTS = 128 };
    const double from = gamma + pi / 2 - e, step = e / PARTS;
    double sum = 0;
    for (int i = 0; i <= PARTS; i++) {
        const double angle = from + i * step, weight = i == 0 || i == PARTS ? 1 : i % 2 ? 4 : 2;
        sum += weight * fabs(sin(angle)) * cos(angle - gamma);
    }
    return sum * step / 3;
}
/* The elevation is given as a fraction of the side, and γ as an angle. */
static void elevation_and_gamma(float *x) {
    const double gamma = (double)x[1], e = (double)x[0] * (pi / 2 + gamma);
    x[0] = (float)e;
    x[1] = (float)sin(e);
    x[2] = (float)cos(e);
    x[3] = (float)sin(gamma);
    x[4] = (float)cos(gamma);
}
static void expect_occluded(const double *x, double *y) {
    y[0] = slice(x[0], atan2(x[3], x[4]));
}
static void sine_and_cosine(float *x) {
    const double gamma = (double)x[0];
    x[1] = (float)sin(gamma);
    x[2] = (float)cos(gamma);
}
static void expect_side(const double *x, double *y) {
    y[0] = slice(pi / 2 + x[0], x[0]);
}
/* A point of the unit disc, and the hemisphere above it. */
static void expect_cosine(const double *x, double *y) {
    y[0] = sqrt(x[0]);
    y[1] = sqrt(1 - x[0]);
}

/* clang-format off */
static const struct function list[] = {
    {"occluded part of a slice", "from the tangent plane up to a horizon, flat and up to the view vector, for any tilt of the normal", "slice_occluded(a.x, a.y, a.z, a.w, b.x)", "elevation sine cosine gamma_sine gamma_cosine",
     {{LINEAR, 0, 1, 0}, {LINEAR, -1.57, 1.57, ZERO}}, elevation_and_gamma, expect_occluded, 1, ABSOLUTE, 6e-7, "five roundings of up to pi, and four of the arguments, which contradict each other by as much"},
    {"side of a slice", "everything from the tangent plane to the view vector", "slice_side(a.x, a.y, a.z)", "gamma gamma_sine gamma_cosine",
     {{LINEAR, -1.57, 1.57, ZERO}}, sine_and_cosine, expect_side, 1, ABSOLUTE, 5e-7, "three roundings of up to pi, and two of the arguments"},
    {"cosine-weighted direction", "length of its part in the surface and height over it", "length(cosine_direction(a.xy).xy), cosine_direction(a.xy).z, 0.0, 0.0", "u v",
     {{LINEAR, 0, 1, ZERO}, {LINEAR, 0, 1, ZERO}}, NULL, expect_cosine, 2, ABSOLUTE, 1e-3, "sine and cosine are 2^-11 off (Vulkan)"},
};
/* clang-format on */

const struct function_list functions_hemisphere = {list, sizeof list / sizeof *list};
