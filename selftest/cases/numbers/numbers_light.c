/* Light of all magnitudes, and the report of invalid values. */
#include "cases/numbers/numbers_light.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Factors on all light, in float ---- */

static bool mafia3(struct pictures *pictures, const struct case_context *context, const struct open_box *box,
                   struct picture *composed, struct glint_error *err) {
    return pictures_begin_preset(pictures, context, "mafia3", err) && pictures_box(pictures, box, err) &&
           pictures_read(pictures, "composed", composed, err);
}

/* A factor on all light is a factor on the image. */
static bool check_factor(const struct case_context *context, double light, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    struct pictures pictures = {0};
    struct picture usual = {0}, found = {0};
    bool ok = mafia3(&pictures, context, &(struct open_box){.roughness = 0.3f}, &usual, err) &&
              pictures_box(&pictures, &(struct open_box){.roughness = 0.3f, .light = light}, err) &&
              pictures_read(&pictures, "composed", &found, err);
    for (size_t i = 0; ok && i < (size_t)found.width * found.height; i++)
        for (size_t k = 0; k < 3; k++) found.values[4 * i + k] = (float)((double)found.values[4 * i + k] / light);
    if (ok) pictures_compare(&usual, &found, NULL, NULL, finding);
    free(usual.values), free(found.values);
    pictures_end(&pictures);
    return ok;
}

static void set_all(void *user, const char *part, const char *channel, float *plane, uint32_t width, uint32_t height) {
    const float *value = user;
    if (strcmp(part, "gbuffer") == 0 || strchr("RGB", channel[0]) == NULL) return;
    for (size_t i = 0; i < (size_t)width * height; i++) plane[i] = *value;
}

/* Everything emits the same light, small enough for a device to flush it to 0. */
static bool check_even(const struct case_context *context, double light, struct glint_selftest_finding *finding,
                       struct glint_error *err) {
    struct pictures pictures = {0};
    struct picture found = {0};
    float value = (float)light;
    bool ok = mafia3(&pictures, context, &(struct open_box){.roughness = 0.3f, .change = set_all, .user = &value},
                     &found, err);
    for (size_t i = 0; ok && i < (size_t)found.width * found.height * 3; i++) {
        const double f = (double)found.values[i / 3 * 4 + i % 3];
        const double error = isnan(f) ? (double)INFINITY
                             : f < 0  ? -f
                                      : fmax(f - 2.01 * light, 0); /* its own light and its reflection */
        finding->values++;
        if (error <= finding->worst) continue;
        finding->worst = error;
        snprintf(finding->at, sizeof finding->at, "pixel %zu,%zu: found %.9g", i / 3 % found.width, i / 3 / found.width,
                 f);
    }
    free(found.values);
    pictures_end(&pictures);
    return ok;
}

/* ---- What is reported ---- */

static void expect_number(struct glint_selftest_finding *finding, const char *what, double found, double expected) {
    finding->values++;
    if (found == expected) return;
    finding->worst = INFINITY;
    snprintf(finding->at, sizeof finding->at, "%s: found %.9g, expected %.9g", what, found, expected);
}

static void expect_report(const struct glint_bad_values *list, size_t count, const char *slot, const char *image,
                          const char *channel, const double expected[4], struct glint_selftest_finding *finding) {
    static const char *const names[] = {"not finite", "clamped", "x of the first", "y of the first"};
    for (size_t i = 0; i < count; i++) {
        const struct glint_bad_values *bad = &list[i];
        if (strcmp(bad->image, image) != 0 || (bad->pass ? !slot || strcmp(bad->pass->slot, slot) != 0 : slot != NULL))
            continue;
        const double found[4] = {(double)bad->not_finite, (double)bad->clamped, bad->x, bad->y};
        for (int k = 0; k < 4; k++)
            if (expected[k] >= 0) expect_number(finding, names[k], found[k], expected[k]);
        expect_number(finding, "the channel's name", strcmp(bad->channel, channel) == 0, 1);
        return;
    }
    expect_number(finding, "reports", (double)count, -1);
}

/* The box in half with light of 10^6: stored values are half's largest, and each one is counted. */
static bool check_clamped(const struct case_context *context, double light, struct glint_selftest_finding *finding,
                          struct glint_error *err) {
    struct pictures pictures = {0};
    struct picture found = {0};
    const struct glint_bad_values *list = NULL;
    size_t count = 0;
    float value = (float)light;
    char path[4096];
    snprintf(path, sizeof path, "%s/light.exr", context->folder);
    bool ok = pictures_begin(&pictures, context, "", err) &&
              open_box_write(&(struct open_box){.change = set_all, .user = &value}, path, err) &&
              pictures_replay(&pictures, path, &(struct glint_replay_options){0}, err) &&
              pictures_read(&pictures, "composed", &found, err) &&
              glint_replay_bad_values(pictures.replay, &list, &count, err);
    for (size_t i = 0; ok && i < (size_t)found.width * found.height * 3; i++)
        expect_number(finding, "light", (double)found.values[i / 3 * 4 + i % 3], 65504);
    const double pixels = ok ? 3.0 * found.width * found.height : 0;
    if (ok) expect_report(list, count, NULL, "lit", "R", (double[]){0, pixels, 0, 0}, finding);
    if (ok)
        expect_report(list, count, NULL, "cubemap_color", "R", (double[]){0, 3.0 * 6 * 32 * 32 * OPEN_BOX_CUBES, 0, 0},
                      finding);
    if (ok) expect_report(list, count, "compose", "composed", "R", (double[]){0, pixels, 0, 0}, finding);
    free(found.values);
    pictures_end(&pictures);
    return ok;
}

/* An open box whose lit image has one bad pixel in channel G. */
static const uint32_t bad_pixel[2] = {64, 27};
static void spoil_one(void *user, const char *part, const char *channel, float *plane, uint32_t width,
                      uint32_t height) {
    const float *value = user;
    (void)height;
    if (strcmp(part, "lit") == 0 && channel[0] == 'G') plane[bad_pixel[1] * width + bad_pixel[0]] = *value;
}

/* The picture has the bad light in its own pixel, and no pass before it makes a value that is not finite. */
static bool check_report(const struct case_context *context, double bad, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    struct pictures pictures = {0};
    const struct glint_bad_values *list = NULL;
    size_t count = 0, first = 0;
    float value = (float)bad;
    const struct open_box box = open_box_filled(&(struct open_box){.change = spoil_one, .user = &value});
    const bool ok = pictures_begin(&pictures, context, "", err) && pictures_box(&pictures, &box, err) &&
                    glint_replay_bad_values(pictures.replay, &list, &count, err);
    while (first < count && !list[first].pass) first++;
    if (ok && isfinite(bad)) expect_number(finding, "images with bad values", (double)count, 0);
    else if (ok) {
        const double captured[] = {1, 0, bad_pixel[0], bad_pixel[1]}, composed[] = {-1, 0, bad_pixel[0], bad_pixel[1]};
        expect_report(list, count, NULL, "lit", "G", captured, finding);
        expect_report(list, count, "compose", "composed", "G", composed, finding);
        expect_number(finding, "passes with bad values", first < count, 1);
    }
    if (first < count) {
        expect_number(finding, "compose is the first pass", strcmp(list[first].pass->slot, "compose") == 0, 1);
        expect_number(finding, "one of its values is bad", (double)list[first].not_finite, 1);
    }
    pictures_end(&pictures);
    return ok;
}

/* ---- The cases ---- */

/* clang-format off */
#define FACTOR "a factor on all light, in float: the picture is multiplied by it", "absolute", 6e-7, "a product rounds in ten places, from the capture to the composed picture, by 6e-8 each"
#define REPORT "count, first pass, first pixel and channel", "exact", 0, "a count"
static const struct light_case {
    const char *name, *what, *unit;
    double bound;
    const char *reason;
    double light;
    bool (*check)(const struct case_context *context, double light, struct glint_selftest_finding *finding, struct glint_error *err);
} cases[] = {
    {"light times 2^-100", FACTOR, 0x1p-100, check_factor},
    {"light times 65504", FACTOR, 65504, check_factor},
    {"light times 10^6", FACTOR, 1e6, check_factor},
    {"light times 10^30", FACTOR, 1e30, check_factor},
    {"no light", "nothing comes of nothing", "absolute", 0, "sums and products of 0", 0, check_even},
    {"denormal light", "10^-40 everywhere: the picture has at most the reflection added, and is not negative", "absolute", 1.5e-45, "a denormal's last bit, beyond the environment BRDF's fit, which may send 0.5 % too much; devices may make 0 of any", 1e-40, check_even},
    {"light beyond half", "10^6 everywhere, in half: 65504 everywhere, and every clamped value is counted", "absolute", 0, "clamped, not rounded", 1e6, check_clamped},
    {"report of NaN", REPORT, NAN, check_report},
    {"report of infinite light", REPORT, INFINITY, check_report},
    {"report of good light", "10^6 in float is not reported", "exact", 0, "a count", 1e6, check_report},
};
/* clang-format on */

size_t numbers_light_count(void) {
    return sizeof cases / sizeof *cases;
}

struct glint_selftest_case numbers_light_get(size_t i) {
    return (struct glint_selftest_case){cases[i].name, cases[i].what,  NULL,
                                        cases[i].unit, cases[i].bound, cases[i].reason};
}

bool numbers_light_run(const struct case_context *context, const bool *selected,
                       struct glint_selftest_finding *findings, struct glint_error *err) {
    bool ok = true;
    for (size_t i = 0; ok && i < numbers_light_count(); i++)
        if (!selected[i]) continue;
        else if (context->quick && i > 0 && cases[i].check == cases[i - 1].check) findings[i].left_out = true;
        else ok = cases[i].check(context, cases[i].light, &findings[i], err);
    return ok;
}
