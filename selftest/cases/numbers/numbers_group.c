/* The group "numbers": one image in all representations of its values. */
#include "cases/groups.h"
#include "cases/numbers/numbers_depth.h"
#include "cases/numbers/numbers_half.h"
#include "cases/numbers/numbers_light.h"
#include "harness/convention_case.h"

/* clang-format off */
#define STEEP "; light follows 56 times the relative error of depth: the floor is seen at a grazing angle, where ends move by up to 15 times what depth does, 8 m away, over walls that change by 0.5 a metre"
#define ROUNDED "six roundings of 6e-8" STEEP

static const struct convention_case places[] = {
    {"moved by 10^3 m", "the whole world is moved: the picture does not change", {.offset_m = {1e3, -1e3, 1e3}}, 2e-5, .reason = ROUNDED},
    {"moved by 10^4 m", "the whole world is moved: the picture does not change", {.offset_m = {-1e4, 1e4, 1e4}}, 2e-5, .reason = ROUNDED},
    {"moved by 10^5 m", "the whole world is moved: the picture does not change", {.offset_m = {1e5, 1e5, -1e5}}, 2e-5, .reason = ROUNDED},
    {"moved by 10^6 m", "the whole world is moved: the picture does not change", {.offset_m = {1e6, -250, 3e6}}, 2e-5, .reason = ROUNDED},
    {"moved by 10^7 m", "the whole world is moved: the picture does not change", {.offset_m = {-1e7, 1e7, -1e7}}, 2e-5, .reason = ROUNDED},
    {"device depth", "near to far as 0 to 1", {.encodings.depth = GLINT_DEPTH_DEVICE}, 1.4e-4, .reason = "near 1 a stored float rounds depth by 3e-8 z/near, 2.4e-6" STEEP},
    {"reversed depth", "near to far as 1 to 0", {.encodings.depth = GLINT_DEPTH_REVERSED}, 2e-5, .reason = ROUNDED},
    {"reversed depth without far plane", "near to infinity as 1 to 0", {.encodings.depth = GLINT_DEPTH_REVERSED_INFINITE}, 2e-5, .reason = ROUNDED},
    {"logarithmic depth", "log near to log far as 0 to 1", {.encodings.depth = GLINT_DEPTH_LOGARITHMIC}, 3.5e-5, .reason = "a stored float rounds depth by 3e-8 of the logarithm's span of 9, and six roundings of 6e-8" STEEP},
    {"reversed logarithmic depth", "log near to log far as 1 to 0", {.encodings.depth = GLINT_DEPTH_LOGARITHMIC_REVERSED}, 3.5e-5, .reason = "a stored float rounds depth by 3e-8 of the logarithm's span of 9, and six roundings of 6e-8" STEEP},
    {"gloss", "one less roughness", {.encodings.roughness = GLINT_ROUGHNESS_GLOSS}, 0, .reason = "a mirror's 1 is exact"},
    {"Blinn-Phong power", "an infinite power is a mirror", {.encodings.roughness = GLINT_ROUGHNESS_POWER}, 0, .reason = "roughness 0 is exact"},
    {"pre-exposed colour", "exposed before it was stored", {.encodings.color = GLINT_COLOR_PRE_EXPOSED, .pre_exposure = 0.3}, 3e-7, .reason = "light below 1 is rounded four more times by 6e-8: when exposed, stored, decoded and weighted"},
    {"sRGB colour", "stored through sRGB's curve", {.encodings.color = GLINT_COLOR_SRGB}, 6e-7, .reason = "light below 1, stored through a power of 2.4 and decoded in floats: 1 + 2.4 times 6e-8 each, and of the power 2 ULP"},
    {"millimetres", "a thousand units a metre", {.metres_per_unit = 1e-3}, 2e-5, .reason = ROUNDED},
    {"kilometres", "a thousandth of a unit a metre", {.metres_per_unit = 1e3}, 2e-5, .reason = ROUNDED},
    {"a world of millimetres", "all lengths times 0.001, including parameters in metres", {.scale = 1e-3}, 2e-5, .reason = ROUNDED},
    {"a world of centimetres", "all lengths times 0.01, including parameters in metres", {.scale = 1e-2}, 2e-5, .reason = ROUNDED},
    {"a world of decametres", "all lengths times 10, including parameters in metres", {.scale = 10}, 2e-5, .reason = ROUNDED},
    {"a world of kilometres", "all lengths times 1000, including parameters in metres", {.scale = 1e3}, 2e-5, .reason = ROUNDED},
};
/* clang-format on */

enum { PLACES = sizeof places / sizeof *places };
static const struct convention_set kind = {.image = "composed", .cases = places, .count = PLACES};

/* The parts of the group, one after the other. */
static size_t places_count(void) {
    return PLACES;
}
static struct glint_selftest_case places_get(size_t i) {
    return convention_case_get(&places[i]);
}
static bool places_run(const struct case_context *context, const bool *selected,
                       struct glint_selftest_finding *findings, struct glint_error *err) {
    return convention_set_run(context, &kind, selected, findings, err);
}
static const struct part {
    size_t (*count)(void);
    struct glint_selftest_case (*get)(size_t i);
    bool (*run)(const struct case_context *context, const bool *selected, struct glint_selftest_finding *findings,
                struct glint_error *err);
} parts[] = {
    {places_count, places_get, places_run},
    {numbers_depth_count, numbers_depth_get, numbers_depth_run},
    {numbers_half_count, numbers_half_get, numbers_half_run},
    {numbers_light_count, numbers_light_get, numbers_light_run},
};
enum { PARTS = sizeof parts / sizeof *parts };

static size_t numbers_count(void) {
    size_t all = 0;
    for (size_t p = 0; p < PARTS; p++) all += parts[p].count();
    return all;
}
static struct glint_selftest_case numbers_get(size_t i) {
    size_t p = 0;
    for (; i >= parts[p].count(); p++) i -= parts[p].count();
    return parts[p].get(i);
}
static bool numbers_run(const struct case_context *context, const bool *selected,
                        struct glint_selftest_finding *findings, struct glint_error *err) {
    bool ok = true;
    for (size_t p = 0, first = 0; ok && p < PARTS; first += parts[p++].count())
        ok = parts[p].run(context, selected + first, findings + first, err);
    return ok;
}

const struct case_group numbers_group = {"numbers", "the same picture for all ways to store its numbers", numbers_count,
                                         numbers_get, numbers_run};
