/* Cases of sun.glsl. */
#include "cases/functions/function_case.h"

static double limited(double x) {
    return x > 0 ? fmin(x, 1) : 0;
}
static void expect_mask(const double *x, double *y) {
    y[0] = limited(x[0]);
}
static void expect_end(const double *x, double *y) {
    y[0] = x[2] > 0 ? limited((x[1] - x[0]) / (x[2] * x[1])) : 1;
}
static void expect_border(const double *x, double *y) {
    const double inside = fmin(fmin(x[0], x[1]), fmin(1 - x[0], 1 - x[1]));
    y[0] = x[2] > 0 ? limited(inside / x[2]) : 1;
}
/* The middle's height and turn, then angle, u and v. */
static void unit_middle(float *x) {
    const double height = (double)x[0], turn = (double)x[1], flat = sqrt(1 - height * height);
    x[5] = x[4];
    x[4] = x[3];
    x[3] = x[2];
    x[0] = (float)(flat * cos(turn));
    x[1] = (float)(flat * sin(turn));
    x[2] = (float)height;
}
/* Of a direction with the tangent t to the middle; the one opposite is as far away on the other side. */
static void expect_disc(const double *x, double *y) {
    const double t = tan(x[3]) * sqrt(x[4]);
    y[0] = 1 / sqrt(1 + t * t);
    y[1] = t / sqrt(1 + t * t);
    y[2] = 1;
    y[3] = (1 - t * t) / (1 + t * t);
}

/* clang-format off */
static const struct function list[] = {
    {"valid mask", "a mask is limited to [0, 1]", "valid_mask(a.x), 0.0, 0.0, 0.0", "captured", {{LINEAR, 0, 2, ZERO | NEGATIVE | ENDLESS}}, NULL, expect_mask, 1, ULP, 0, "comparisons"},
    {"fade at the end", "of hits over the last part of a ray's length", "faded_at_end(a.x, a.y, a.z), 0.0, 0.0, 0.0", "travelled length part",
     {{LINEAR, 0, 4, ZERO}, {LINEAR, 0.25, 4, 0}, {LINEAR, 0.125, 1, ZERO}}, NULL, expect_end, 1, ABSOLUTE, 4e-6, "differences of up to 4 are divided by 1/32 at least"},
    {"fade at the border", "of hits near any side of the picture", "faded_at_border(a.xy, a.z), 0.0, 0.0, 0.0", "u v part",
     {{LINEAR, -0.25, 1.25, ZERO}, {LINEAR, -0.25, 1.25, ZERO}, {LINEAR, 0.0625, 0.5, ZERO}}, NULL, expect_border, 1, ABSOLUTE, 4e-6, "a difference of 1 is divided by 1/16 at least"},
    {"direction in the sun's disc", "cosine and sine of its angle to the middle, its length, and the cosine of its angle to the one opposite", "dot(disc_direction(a.xyz, a.w, b.xy), a.xyz), length(cross(disc_direction(a.xyz, a.w, b.xy), a.xyz)), length(disc_direction(a.xyz, a.w, b.xy)), dot(disc_direction(a.xyz, a.w, b.xy), disc_direction(a.xyz, a.w, vec2(b.x, fract(b.y + 0.5))))", "x y z angle u v",
     {{LINEAR, -1, 1, ZERO}, {LINEAR, -3, 3, 0}, {LINEAR, 0, 1.2, ZERO}, {LINEAR, 0, 1, ZERO}, {LINEAR, 0, 1, ZERO}}, unit_middle, expect_disc, 4, ABSOLUTE, 3e-3, "the sine of phi is 2^-11 off (Vulkan), the tangent up to 2.6 times as much"},
};
/* clang-format on */

const struct function_list functions_sun = {list, sizeof list / sizeof *list};
