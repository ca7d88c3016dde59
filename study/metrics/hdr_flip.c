/* HDR-FLIP: Andersson, Nilsson, Shirley, Akenine-Möller, Visualizing Errors in Rendered High Dynamic Range Images, 2021. */
#include <math.h>
#include <stdlib.h>

#include "flip.h"
#include "glint/sort.h"
#include "tone.h"

/* The value, near the shoulder of the tone curve, that the brightest pixel gets at the first exposure and the median pixel at the last. */
static const double SHOWN = 0.85;

/* The radiance that the curve maps to `shown`: the positive root of a quadratic. */
static double radiance_shown_as(double shown) {
    const struct tone_curve *t = &ACES;
    double a = t->a - shown * t->d, b = t->b - shown * t->e, c = t->c - shown * t->f;
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}

/* Highest and median luminance of the compared pixels of the truth. If more than half of them are black, the median is that of the others, since
   black does not depend on exposure. False if all are black. */
static bool find_luminances(const struct comparison *c, float *values, double *highest, double *median) {
    size_t pixels = (size_t)c->found->width * c->found->height, n = 0, black = 0;
    for (size_t i = 0; i < pixels; i++) {
        float rgb[3];
        if (c->use[i] != COMPARED) continue;
        read_rgb(c, true, i, rgb);
        values[n++] = luminance(rgb);
    }
    glint_sort_floats(values, n);
    while (black < n && !(values[black] > 0)) black++;
    if (black == n) return false;
    size_t from = black > (n - 1) / 2 ? black : 0;
    n -= from;
    *highest = (double)values[from + n - 1];
    *median = ((double)values[from + (n - 1) / 2] + (double)values[from + n / 2]) / 2;
    return true;
}

static bool choose_exposures(const struct comparison *c, struct glint_error *err) {
    struct glint_metric_table *t = c->table;
    double highest = 0, median = 0;
    t->start_exposure = c->options->start_exposure;
    t->stop_exposure = c->options->stop_exposure;
    if (t->start_exposure == 0 && t->stop_exposure == 0) {
        float *values = malloc(((size_t)c->found->width * c->found->height + 1) * sizeof *values);
        if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "HDR-FLIP: out of memory");
        if (find_luminances(c, values, &highest, &median)) {
            t->start_exposure = log2(radiance_shown_as(SHOWN) / highest);
            t->stop_exposure = log2(radiance_shown_as(SHOWN) / median);
        }
        free(values);
    }
    if (!(t->start_exposure <= t->stop_exposure && t->stop_exposure - t->start_exposure <= 256))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "HDR-FLIP: expected exposures that rise by at most 256 f-stops, found %g to %g",
                          t->start_exposure, t->stop_exposure);
    t->exposures = (uint32_t)fmax(2, ceil(t->stop_exposure - t->start_exposure));
    return true;
}

static bool compare_exposures(const struct comparison *c, struct flip *flip, struct glint_error *err) {
    struct glint_metric_table *t = c->table;
    if (!choose_exposures(c, err)) return false;
    for (uint32_t k = 0; k < t->exposures; k++)
        flip_add(flip, t->start_exposure + (t->stop_exposure - t->start_exposure) * k / (t->exposures - 1), true,
                 t->hdr_flip);
    return true;
}

bool map_flip(struct comparison *c, struct glint_error *err) {
    const bool low = has_metric(c, GLINT_METRIC_FLIP), high = has_metric(c, GLINT_METRIC_HDR_FLIP);
    struct glint_metric_table *t = c->table;
    struct flip flip = {0};
    if (!c->has_rgb || (!low && !high)) return true;
    if (!flip_begin(&flip, c, err)) return false;
    if (low) t->flip = calloc(flip.pixels, sizeof *t->flip);
    if (high) t->hdr_flip = calloc(flip.pixels, sizeof *t->hdr_flip);
    bool ok =
        ((t->flip || !low) && (t->hdr_flip || !high)) || glint_fail(err, GLINT_ERROR_MEMORY, "FLIP: out of memory");
    if (ok && low) flip_add(&flip, c->options->exposure, false, t->flip);
    if (ok && high) ok = compare_exposures(c, &flip, err);
    flip_end(&flip);
    return ok;
}
