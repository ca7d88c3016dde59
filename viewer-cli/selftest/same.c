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
        if (ok) pictures_compare(expected, &found, NULL, &ties, finding);
        free(found.values);
    }
    filter_limit_ties(finding);
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
              replay(&pictures, kind, &kind->usual, &expected, err) &&
              filter_slack(test, pictures.capture, &slack, err);
    for (size_t i = 0; ok && i < kind->count; i++)
        if (chosen[i]) ok = run_case(&pictures, kind, &kind->cases[i], slack, &expected, &findings[i], err);
    free(expected.values);
    pictures_end(&pictures);
    return ok;
}
