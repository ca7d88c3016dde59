/* Finds depth that was quantized before it was captured: values that all are multiples of the step of a coarser format than the
   declared one, and surfaces whose orientation such steps hide. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lint.h"

/* The step of a format at a value, and the distance of the value to the nearest multiple of it. */
static double off_step(const struct lint_rounding *r, double v, double *step) {
    int exponent;
    frexp(v, &exponent);
    *step = r->fixed ? 1 / (ldexp(1, r->bits) - 1) : ldexp(1, exponent - 1 - r->bits);
    return fabs(v - *step * nearbyint(v / *step));
}

/* Converts a distance to the device depth of this camera. */
static double to_device(const struct lint_data *data, enum glint_clip_z clip_z, double distance) {
    const double *p = data->frame.camera.view_to_clip, z = p[10] * p[14] + p[11] / distance;
    return clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? (z + 1) / 2 : z;
}

/* Whether all values are multiples of a format's step. Values whose own float rounding is coarser than a tenth of the step would pass
   by chance and are skipped; too few different values, as of a wall that faces the camera, prove nothing either. */
static bool all_lie_on(const struct lint_data *data, const struct lint_rounding *r) {
    enum { DIFFERENT = 16 };
    double seen[DIFFERENT];
    size_t asked = 0, different = 0, off = 0;
    for (size_t i = 0; i < data->sample_count; i++) {
        const double stored = (double)data->depth[data->samples[i]];
        if (!isfinite(stored) || stored <= 0 || (data->encodings.depth != GLINT_DEPTH_VIEW_LINEAR && stored >= 1))
            continue;
        const double v = r->of_device ? to_device(data, r->clip_z, stored) : stored;
        /* rounding of a float distance, converted to device depth where needed */
        const double own =
            r->of_device ? ldexp(fabs(data->frame.camera.view_to_clip[11]) / stored, -22) + 1e-15 : ldexp(stored, -24);
        double step;
        const double away = off_step(r, v, &step);
        if (!(v > 0) || own > 0.05 * step) continue;
        asked++;
        off += away > own;
        size_t k = 0;
        while (k < different && seen[k] != stored) k++;
        if (k == different && different < DIFFERENT) seen[different++] = stored;
    }
    return asked >= LINT_ENOUGH && different == DIFFERENT && off * 500 <= asked;
}

/* Tries common depth formats from the coarsest to the finest. */
void lint_find_rounding(struct lint_data *data) {
    enum { LEAST_BITS = 8, MOST_BITS = 18 };
    const bool distances = data->encodings.depth == GLINT_DEPTH_VIEW_LINEAR;
    for (int bits = LEAST_BITS; bits <= MOST_BITS + 1; bits++)
        for (int of = 0; of < (distances ? 3 : 1); of++) {
            struct lint_rounding r = {.fixed = bits <= MOST_BITS,
                                      .bits = bits <= MOST_BITS ? bits : 10,
                                      .of_device = of > 0,
                                      .clip_z = of == 2 ? GLINT_CLIP_Z_MINUS_ONE_TO_ONE : GLINT_CLIP_Z_ZERO_TO_ONE};
            if ((distances && !r.of_device && r.fixed) || !all_lie_on(data, &r)) continue;
            if (r.fixed) snprintf(r.format, sizeof r.format, "%d-bit fixed point", bits);
            else snprintf(r.format, sizeof r.format, "half float");
            data->rounding = r;
            return;
        }
}

double lint_rounding_step(const struct lint_data *data, double stored) {
    const struct lint_rounding *r = &data->rounding;
    double step;
    if (!r->format[0] || !(stored > 0)) return 0;
    off_step(r, r->of_device ? to_device(data, r->clip_z, stored) : stored, &step);
    if (!r->of_device) return step;
    /* the derivative of device depth by distance */
    return step * stored * stored / fabs(data->frame.camera.view_to_clip[11]) *
           (r->clip_z == GLINT_CLIP_Z_MINUS_ONE_TO_ONE ? 2 : 1);
}

/* ---- Surfaces whose orientation is lost ---- */

void lint_find_coarse_depth(const struct lint_data *data, const struct lint_reading *reading, const char *depth_text,
                            struct lint_findings *findings) {
    const struct lint_eyes eyes = lint_eyes_of(data, reading);
    size_t all = 0, unsure = 0, hidden = 0;
    for (size_t i = 0; i < data->sample_count; i++) {
        const uint32_t pixel = data->samples[i];
        double f[3], n[3];
        const enum lint_facet facet = lint_facet_of(data, reading, &eyes.now, pixel, f);
        if (facet == LINT_NO_FACET || !lint_normal(data, reading, &eyes.now, pixel, n)) continue;
        all++;
        unsure += facet == LINT_UNSURE_FACET;
        hidden += facet == LINT_UNSURE_FACET && !lint_same_direction(f, n);
    }
    /* Fewer than a fifth of the surfaces may simply be far away, where every format is coarse. */
    if (all < LINT_ENOUGH || 5 * hidden < all) return;
    struct lint_finding *f = lint_add(findings, "depth.coarse", "certain");
    if (data->rounding.format[0])
        snprintf(f->what, sizeof f->what, "depth is too coarse: its values %sare quantized to %s",
                 data->rounding.of_device ? "as device depth " : "", data->rounding.format);
    snprintf(
        f->evidence, sizeof f->evidence,
        "rounding alone may rotate %zu of %zu surfaces by more than 3 degrees, and %zu of these do not match their "
        "normals; %s",
        unsure, all, hidden, depth_text);
}
