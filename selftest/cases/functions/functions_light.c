/* Cases of light_terms.glsl and light_volume.glsl. */
#include "cases/functions/function_case.h"

static const double sun[] = {3, 2, 1}; /* irradiance */

/* What a new shadow takes of the sun is what its captured mask lets through and the shadow does not. */
static void expect_changed(const double *x, double *y) {
    const double lost = x[7] < x[6] && x[5] > 0 ? (x[6] - x[7]) * x[5] / pi : 0;
    for (int k = 0; k < 3; k++) {
        const double light = x[0] - x[1] + x[2] * x[1] + x[4] * x[3] - x[4] * lost * sun[k];
        y[k] = light > 0 ? light : 0;
    }
}
static void expect_kept(const double *x, double *y) {
    y[0] = x[1] > 1.0 / 64 ? x[0] / x[1] : 64 * x[0];
}

/* A cube with the sides 1, 2, 3 (positive) and 4, 5, 6: of each pair the one that the direction faces, by the square of its component. */
static void expect_cube(const double *x, double *y) {
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += x[k] * x[k] * (x[k] < 0 ? 4 + k : 1 + k);
    y[0] = sum;
    y[1] = 3.5;
}
/* Of light that varies linearly with the direction, radiance 1 + 3 m·d; a white surface sends back (2/3 of it varies): quadrature by rings about
   the direction, ∫ (1 + 3 m·ω) cos dω / π, in which the part of m across the direction cancels. */
static void expect_directed(const double *x, double *y) {
    enum { RINGS = 2000 };
    const double along = x[0] * x[3] + x[1] * x[4] + x[2] * x[5];
    double sum = 0;
    for (int i = 0; i < RINGS; i++) {
        const double cosine = (i + 0.5) / RINGS;
        sum += 2 * cosine * (1 + 3 * along * cosine) / RINGS;
    }
    y[0] = x[6] * sum;
}
static void expect_contrasted(const double *x, double *y) {
    const double light = (1 - x[2]) * x[0] + x[2] * x[1];
    y[0] = light > 0 ? light : 0;
}
static void expect_luminance(const double *x, double *y) {
    y[0] = 0.2126 * x[0] + 0.7152 * x[1] + 0.0722 * x[2];
}
/* Slices of 7 rows each. */
static void expect_cell(const double *x, double *y) {
    y[0] = x[0];
    y[1] = x[1] + 7 * x[2];
}

/* clang-format off */
static const struct function list[] = {
    {"changed light", "occluded, with traced indirect light, and less sun where only the traced shadow is dark", "changed_light(vec3(a.x), vec3(a.y), a.z, vec3(a.w), vec3(b.x), SunTerm(vec3(3.0, 2.0, 1.0), b.y, b.z, b.w)), 0.0",
     "lit indirect kept traced albedo cosine mask shadow",
     {{LINEAR, 0, 4, 0}, {LINEAR, 0, 4, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 4, 0}, {LINEAR, 0, 1, 0}, {LINEAR, -1, 1, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}}, NULL, expect_changed, 3, ABSOLUTE, 4e-6, "eight roundings of numbers up to 8"},
    {"kept light", "the engine's own occlusion is taken out, down to a 64th", "kept_light(a.x, a.y)", "visible engine", {{LINEAR, 0, 1, ZERO}, {LINEAR, 0, 1, ZERO}}, NULL, expect_kept, 1, ULP, 3, "a division, 2.5 ULP (Vulkan)"},
    {"ambient cube", "the sides that a direction faces, by its squared components, and the mean of all", "ambient_cube(vec3[](vec3(1.0), vec3(2.0), vec3(3.0)), vec3[](vec3(4.0), vec3(5.0), vec3(6.0)), a.xyz).x, ambient_cube_mean(vec3[](vec3(1.0), vec3(2.0), vec3(3.0)), vec3[](vec3(4.0), vec3(5.0), vec3(6.0))).x, 0.0, 0.0",
     "x y z", {{LINEAR, -1, 1, ZERO}, {LINEAR, -1, 1, ZERO}, {LINEAR, -1, 1, ZERO}}, NULL, expect_cube, 2, ABSOLUTE, 4e-6, "six roundings of numbers up to 15"},
    {"directed light", "what a white surface sends back of light that varies linearly with the direction", "directed_irradiance(vec3(b.z), a.xyz, vec3(a.w, b.xy)), 0.0", "x y z dx dy dz mean",
     {{LINEAR, -1, 1, 0}, {LINEAR, -1, 1, 0}, {LINEAR, -1, 1, 0}, {LINEAR, -1, 1, 0}, {LINEAR, -1, 1, 0}, {LINEAR, -1, 1, 0}, {LINEAR, 0, 4, 0}}, NULL, expect_directed, 1, ABSOLUTE, 1e-5, "roundings of numbers up to 28; 2000 rings leave 1e-6"},
    {"contrasted light", "what differs from the mean is scaled, and never negative", "contrasted(vec3(a.x), vec3(a.y), a.z), 0.0", "mean irradiance contrast", {{LINEAR, 0, 4, 0}, {LINEAR, 0, 4, 0}, {LINEAR, 0, 4, 0}}, NULL, expect_contrasted, 1, ABSOLUTE, 4e-6, "three roundings of numbers up to 16"},
    {"luminance", "of Rec. 709's primaries", "luminance(a.xyz), 0.0, 0.0, 0.0", "r g b", {{LINEAR, -4, 4, ZERO}, {LINEAR, -4, 4, ZERO}, {LINEAR, -4, 4, ZERO}}, NULL, expect_luminance, 1, ABSOLUTE, 2e-6, "five roundings of numbers up to 4, and three of the weights"},
    {"cell of a volume", "slices lie one below the other", "vec4(vec2(cell_texel(ivec3(a.xyz), uvec4(5, 7, 9, 1))), 0.0, 0.0)", "i j k", {{WHOLE, 0, 4, 0}, {WHOLE, 0, 6, 0}, {WHOLE, 0, 8, 0}}, NULL, expect_cell, 2, ULP, 0, "whole numbers"},
};
/* clang-format on */

const struct function_list functions_light = {list, sizeof list / sizeof *list};
