/* Checks what lit holds: diffuse light of this frame, and nothing else. */
#include <math.h>
#include <stdio.h>

#include "glint/sort.h"
#include "lint.h"

static bool is_surface(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                       uint32_t pixel) {
    double depth;
    return lint_depth(data, reading, view, pixel % data->width, pixel / data->width, &depth);
}

static double median(double *values, size_t count) {
    glint_sort_doubles(values, count);
    return count ? values[count / 2] : 0;
}

/* Metal has no diffuse reflection. False when too few samples are metal. */
static bool check_metals(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                         struct lint_findings *findings) {
    static double others[LINT_SAMPLES];
    size_t metals = 0, lit = 0, count = 0;
    for (size_t i = 0; i < data->sample_count; i++) {
        const size_t pixel = data->samples[i];
        if (!is_surface(data, reading, view, (uint32_t)pixel)) continue;
        if (!(data->material[3 * pixel + 1] > 0.95f)) others[count++] = lint_luminance(data->lit + 3 * pixel);
    }
    const double typical = median(others, count);
    for (size_t i = 0; i < data->sample_count; i++) {
        const size_t pixel = data->samples[i];
        if (!is_surface(data, reading, view, (uint32_t)pixel) || !(data->material[3 * pixel + 1] > 0.95f)) continue;
        metals++;
        lit += lint_luminance(data->lit + 3 * pixel) > 0.02 * typical;
    }
    if (metals < 50) return false;
    if (lit < metals / 2) return true;
    struct lint_finding *f = lint_add(findings, "lit.specular", "likely");
    snprintf(f->evidence, sizeof f->evidence,
             "%zu of %zu metal samples are lit, although metal has no diffuse reflection", lit, metals);
    return true;
}

/* Whether the reflectance at normal incidence is at least 2 %. */
static bool reflects(const struct lint_data *data, size_t pixel) {
    const float *m = data->material + 3 * pixel;
    return m[1] > 0.5f || !data->has_specular || m[2] >= 0.25f;
}

/* Equal colours, on surfaces that reflect and are not dark: the finished picture adds what they reflect. */
static struct lint_tally compare_scene(const struct lint_data *data, const struct lint_reading *reading,
                                       const struct lint_view *view) {
    static double bright[LINT_SAMPLES];
    struct lint_tally tally = {0, 0};
    size_t count = 0;
    for (size_t i = 0; i < data->sample_count; i++)
        bright[count++] = lint_luminance(data->scene + 3 * (size_t)data->samples[i]);
    const double dark = 0.1 * median(bright, count);
    for (size_t i = 0; i < data->sample_count; i++) {
        const uint32_t pixel = data->samples[i];
        const float *scene = data->scene + 3 * (size_t)pixel, *lit = lint_lit(data, reading, pixel);
        if (!is_surface(data, reading, view, pixel) || !reflects(data, pixel) || !(lint_luminance(scene) > dark))
            continue;
        bool equal = true;
        for (int k = 0; k < 3; k++) {
            const double a = lint_linear(data, reading->lit, lit[reading->lit_bgr ? 2 - k : k]),
                         b = lint_linear(data, data->scene_encoding, scene[k]);
            equal = equal && fabs(a - b) <= 0.005 * (a + b);
        }
        lint_count(&tally, equal);
    }
    return tally;
}

static void check_specular(const struct lint_data *data, const struct lint_reading *reading,
                           const struct lint_view *view, struct lint_findings *findings) {
    const struct lint_tally same = data->scene ? compare_scene(data, reading, view) : (struct lint_tally){0, 0};
    if (same.count >= LINT_ENOUGH && 50 * same.agree >= 49 * same.count) {
        struct lint_finding *f = lint_add(findings, "lit.scene", "likely");
        snprintf(f->evidence, sizeof f->evidence,
                 "lit and scene have the same colour at %zu of %zu samples of surfaces that reflect", same.agree,
                 same.count);
    } else if (!check_metals(data, reading, view, findings) && same.count < LINT_ENOUGH)
        lint_undecided(findings, "whether lit contains specular light: too few samples are metal, and %s",
                       data->scene ? "too few can be compared with scene" : "there is no scene to compare with");
}

/* False when lit is not that of this frame: then it tells nothing else. */
static bool check_frame(const struct lint_data *data, const struct lint_reading *reading,
                        struct lint_findings *findings) {
    const struct lint_tally same = lint_same_light(data, reading);
    /* equality of so many values is no chance */
    if (same.count < LINT_ENOUGH / 4 || 50 * same.agree < 49 * same.count) return true;
    struct lint_finding *f = lint_add(findings, "lit.previous", "certain");
    snprintf(f->evidence, sizeof f->evidence,
             "lit and previous.lit are equal at %zu of %zu samples where motion by the cameras changes the colour",
             same.agree, same.count);
    return false;
}

static void check_sky(const struct lint_data *data, const struct lint_reading *reading,
                      struct lint_findings *findings) {
    const struct lint_tally black = lint_black_sky(data, reading);
    if (black.count < LINT_ENOUGH || 50 * black.agree < 49 * black.count) return;
    struct lint_finding *f = lint_add(findings, "lit.sky", "certain");
    snprintf(f->evidence, sizeof f->evidence, "lit is 0 at %zu of %zu sky pixels where the sky cube map is not black",
             black.agree, black.count);
}

void lint_find_light(const struct lint_data *data, const struct lint_reading *reading, struct lint_findings *findings) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    check_sky(data, reading, findings);
    if (check_frame(data, reading, findings)) check_specular(data, reading, &eyes.now, findings);
}
