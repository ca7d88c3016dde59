/* Checks what lit holds: diffuse light of this frame, and nothing else. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

struct metal {
    const float *material, *lit;
    double reflected[3]; /* unit direction of the mirror ray */
    bool glows;
};

static bool same_material(const struct metal *a, const struct metal *b) {
    for (int k = 0; k < LINT_MATERIAL; k++)
        if (fabsf(a->material[k] - b->material[k]) > 1.0f / 128) return false;
    return true;
}

static int by_light(const void *a, const void *b) {
    const double x = lint_luminance((*(const struct metal *const *)a)->lit),
                 y = lint_luminance((*(const struct metal *const *)b)->lit);
    return (x > y) - (x < y);
}

/* Whether this material emits its light: nine in ten of its samples have the same colour, within 2 %, although their mirror rays differ by more
   than 20°. What they reflect would differ, too. */
static bool emits(struct metal **of, size_t count) {
    size_t same = 0;
    double mean[3] = {0}, length = 0, least = 1;
    if (count < 16) return false;
    qsort(of, count, sizeof *of, by_light);
    const float *middle = of[count / 2]->lit;
    for (size_t i = 0; i < count; i++) {
        bool alike = true;
        for (int k = 0; k < 3; k++) alike &= fabsf(of[i]->lit[k] - middle[k]) <= 0.01f * (of[i]->lit[k] + middle[k]);
        same += alike;
        for (int k = 0; k < 3; k++) mean[k] += of[i]->reflected[k];
    }
    for (int k = 0; k < 3; k++) length += mean[k] * mean[k];
    for (size_t i = 0; i < count; i++) {
        const double *d = of[i]->reflected;
        least = fmin(least, (d[0] * mean[0] + d[1] * mean[1] + d[2] * mean[2]) / sqrt(length));
    }
    return 10 * same >= 9 * count && least < 0.985;
}

static void find_emitters(struct metal *metals, size_t count) {
    static struct metal *of[LINT_SAMPLES];
    static bool seen[LINT_SAMPLES];
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < count; i++) {
        size_t alike = 0;
        for (size_t k = i; k < count && !seen[i]; k++)
            if (!seen[k] && same_material(&metals[i], &metals[k])) of[alike++] = &metals[k];
        for (size_t k = 0; k < alike; k++) seen[of[k] - metals] = true;
        const bool glow = emits(of, alike);
        for (size_t k = 0; k < alike; k++) of[k]->glows = glow;
    }
}

static bool metal_at(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                     uint32_t pixel, struct metal *out) {
    double p[3], n[3], along = 0, length = 0;
    if (!(data->material[LINT_MATERIAL * (size_t)pixel + 1] > 0.95f) || !lint_place(data, reading, view, pixel, p) ||
        !lint_normal(data, reading, view, pixel, n))
        return false;
    *out = (struct metal){data->material + LINT_MATERIAL * (size_t)pixel, lint_lit(data, reading, pixel), {0}, false};
    for (int k = 0; k < 3; k++) {
        p[k] -= view->position[k];
        along += p[k] * n[k];
        length += p[k] * p[k];
    }
    for (int k = 0; k < 3; k++) out->reflected[k] = (p[k] - 2 * along * n[k]) / sqrt(length);
    return true;
}

/* Metal has no diffuse reflection. What it emits does not count. False when too few samples are metal. */
static bool check_metals(const struct lint_data *data, const struct lint_reading *reading, const struct lint_view *view,
                         struct lint_findings *findings) {
    static double others[LINT_SAMPLES];
    static struct metal found[LINT_SAMPLES];
    size_t metals = 0, lit = 0, count = 0, all = 0;
    for (size_t i = 0; i < data->sample_count; i++) {
        const size_t pixel = data->samples[i];
        if (!is_surface(data, reading, view, (uint32_t)pixel)) continue;
        if (metal_at(data, reading, view, (uint32_t)pixel, &found[all])) all++;
        else others[count++] = lint_luminance(lint_lit(data, reading, (uint32_t)pixel));
    }
    const double typical = median(others, count);
    find_emitters(found, all);
    for (size_t i = 0; i < all; i++) {
        metals += !found[i].glows;
        lit += !found[i].glows && lint_luminance(found[i].lit) > 0.02 * typical;
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
    const float *m = data->material + LINT_MATERIAL * pixel;
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
        lint_undecided(findings,
                       "whether lit contains specular light: too few samples are metal that emits nothing, and %s",
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
