/* Claims that the court gives the same picture under another convention. */
#include "same.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "filter.h"

struct selftest_case same_case(const struct same *same) {
    return (struct selftest_case){same->name, same->what, NULL, "absolute", same->bound, same->reason};
}

/* What the pipeline states in metres grows with the world, within what the parameter may be. */
static bool scale_lengths(struct glint_pipeline *pipeline, double scale, struct glint_error *err) {
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        for (size_t r = 0; r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            if ((row->kind != GLINT_ROW_PUSH && row->kind != GLINT_ROW_SPEC) || strcmp(row->unit, "m") != 0) continue;
            const double value = scale * glint_pipeline_value(pipeline, pass, row);
            char text[200];
            snprintf(text, sizeof text, "%s.%s=%.9g", pass->slot, row->name,
                     fmin(fmax(value, row->lowest), row->highest));
            if (!glint_pipeline_set(pipeline, text, err)) return false;
        }
    }
    return true;
}

static bool replay_frames(struct pictures *pictures, const struct same_kind *kind, struct court court,
                          struct picture_of *out, struct glint_error *err) {
    const struct court *usual = &kind->usual;
    court.width = usual->width, court.height = usual->height;
    court.roughness = usual->roughness;
    memcpy(court.travel_m, usual->travel_m, sizeof court.travel_m);
    bool ok = true;
    for (court.frame = 1; ok && court.frame <= (kind->frames ? kind->frames : 1); court.frame++)
        ok = pictures_court(pictures, &court, err);
    return ok && pictures_read(pictures, kind->image, out, err);
}

static bool replay(struct pictures *pictures, const struct same_kind *kind, const struct court *court,
                   struct picture_of *out, struct glint_error *err) {
    struct glint_pipeline *own = pictures->pipeline;
    bool ok = true;
    if (court->scale > 0)
        ok = (pictures->pipeline = glint_pipeline_copy(own, err)) &&
             scale_lengths(pictures->pipeline, court->scale, err);
    ok = ok && replay_frames(pictures, kind, *court, out, err);
    if (pictures->pipeline != own) glint_pipeline_destroy(&pictures->pipeline);
    pictures->pipeline = own;
    return ok;
}

/* ---- Filters that weigh texels in steps: an end that moves by next to nothing may reach the next one ---- */

static double largest_step(const float *rgb, uint32_t width, uint32_t height) {
    double largest = 0;
    for (uint32_t i = 0; i < width * height; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const double v = (double)rgb[3 * i + k];
            if ((i + 1) % width) largest = fmax(largest, fabs((double)rgb[3 * (i + 1) + k] - v));
            if (i + width < width * height) largest = fmax(largest, fabs((double)rgb[3 * (i + width) + k] - v));
        }
    return largest;
}

/* How far light at the end of a ray may be off because of the weights: two of them, a step each, between the most different
   neighbours of what rays look up. */
static bool filter_slack(const struct pictures *pictures, double *slack, struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B"};
    double step, largest = 0;
    *slack = 0;
    if (!filter_step(pictures->test, &step, err)) return false;
    if (step == 0) return true;
    for (size_t i = 0; i < glint_capture_part_count(pictures->capture); i++) {
        const struct glint_part_info *part = glint_capture_part(pictures->capture, i);
        if (!part->has_cubemap && strcmp(part->name, "lit") != 0) continue;
        float *rgb = malloc((size_t)part->width * part->height * 3 * sizeof *rgb);
        bool ok = rgb || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        ok = ok && glint_capture_read(pictures->capture, part, names, 3, GLINT_F32, rgb, 0, err);
        const uint32_t pictures_of = part->has_cubemap ? 6 : 1, height = part->height / pictures_of;
        for (uint32_t k = 0; ok && k < pictures_of; k++)
            largest = fmax(largest, largest_step(rgb + 3 * (size_t)k * part->width * height, part->width, height));
        free(rgb);
        if (!ok) return false;
    }
    *slack = 2 * step * largest;
    return true;
}

/* Of ends that move by the bound's part of a texel few can be next to a step. */
static void limit_ties(struct selftest_finding *finding) {
    if (100 * finding->ties <= finding->values) return;
    finding->worst = INFINITY;
    snprintf(finding->at, sizeof finding->at, "%zu of %zu values are off by a step of the filter's weights",
             finding->ties, finding->values);
}

static bool run_case(struct pictures *pictures, const struct same_kind *kind, const struct same *same, double slack,
                     const struct picture_of *expected, struct selftest_finding *finding, struct glint_error *err) {
    const struct picture_ties ties = {same->bound, slack};
    const uint32_t step = pictures->test->quick ? 4 : 1;
    bool ok = true;
    for (uint32_t i = 0; ok && (i == 0 || i < same->variants); i += step) {
        struct court court = same->court;
        struct picture_of found = {0};
        if (same->vary) same->vary(i, &court);
        ok = replay(pictures, kind, &court, &found, err);
        if (ok) pictures_compare(expected, &found, NULL, slack > 0 ? &ties : NULL, finding);
        free(found.values);
    }
    limit_ties(finding);
    return ok;
}

bool same_run(const struct selftest *test, const struct same_kind *kind, const bool *chosen,
              struct selftest_finding *findings, struct glint_error *err) {
    struct pictures pictures = {0};
    struct picture_of expected = {0};
    double slack = 0;
    bool any = false;
    for (size_t i = 0; i < kind->count; i++) any = any || chosen[i];
    if (!any) return true;
    bool ok = (kind->preset ? pictures_begin_preset(&pictures, test, kind->preset, err)
                            : pictures_begin(&pictures, test, "", err)) &&
              replay(&pictures, kind, &kind->usual, &expected, err) && filter_slack(&pictures, &slack, err);
    for (size_t i = 0; ok && i < kind->count; i++)
        if (chosen[i]) ok = run_case(&pictures, kind, &kind->cases[i], slack, &expected, &findings[i], err);
    free(expected.values);
    pictures_end(&pictures);
    return ok;
}
