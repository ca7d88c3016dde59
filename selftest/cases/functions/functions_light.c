/* Cases of light_terms.glsl. */
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

/* clang-format off */
static const struct function list[] = {
    {"changed light", "occluded, with traced indirect light, and less sun where only the traced shadow is dark", "changed_light(vec3(a.x), vec3(a.y), a.z, vec3(a.w), vec3(b.x), SunTerm(vec3(3.0, 2.0, 1.0), b.y, b.z, b.w)), 0.0",
     "lit indirect kept traced albedo cosine mask shadow",
     {{LINEAR, 0, 4, 0}, {LINEAR, 0, 4, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 4, 0}, {LINEAR, 0, 1, 0}, {LINEAR, -1, 1, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}}, NULL, expect_changed, 3, ABSOLUTE, 4e-6, "eight roundings of numbers up to 8"},
    {"kept light", "the engine's own occlusion is taken out, down to a 64th", "kept_light(a.x, a.y)", "visible engine", {{LINEAR, 0, 1, ZERO}, {LINEAR, 0, 1, ZERO}}, NULL, expect_kept, 1, ULP, 3, "a division, 2.5 ULP (Vulkan)"},
};
/* clang-format on */

const struct function_list functions_light = {list, sizeof list / sizeof *list};
