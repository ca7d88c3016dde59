/* Cases that the box gives the same picture under another convention. */
#include "harness/convention_case.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/texture_filter.h"

struct glint_selftest_case convention_case_get(const struct convention_case *c) {
    return (struct glint_selftest_case){c->name, c->what, NULL, "absolute", c->bound, c->reason};
}

/* Parameters in metres scale with the world, within their range. */
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

static bool replay_frames(struct pictures *pictures, const struct convention_set *kind, struct open_box box,
                          struct picture *out, struct glint_error *err) {
    const struct open_box *usual = &kind->usual;
    box.width = usual->width, box.height = usual->height;
    box.roughness = usual->roughness;
    memcpy(box.travel_m, usual->travel_m, sizeof box.travel_m);
    bool ok = true;
    for (box.frame = 1; ok && box.frame <= (kind->frames ? kind->frames : 1); box.frame++)
        ok = pictures_box(pictures, &box, err);
    return ok && pictures_read(pictures, kind->image, out, err);
}

static bool replay_box(struct pictures *pictures, const struct convention_set *kind, const struct open_box *box,
                       struct picture *out, struct glint_error *err) {
    struct glint_pipeline *own = pictures->pipeline;
    bool ok = true;
    if (box->scale > 0)
        ok = (pictures->pipeline = glint_pipeline_copy(own, err)) && scale_lengths(pictures->pipeline, box->scale, err);
    ok = ok && replay_frames(pictures, kind, *box, out, err);
    if (pictures->pipeline != own) glint_pipeline_destroy(&pictures->pipeline);
    pictures->pipeline = own;
    return ok;
}

static bool run_convention(struct pictures *pictures, const struct convention_set *kind,
                           const struct convention_case *c, double slack, const struct picture *expected,
                           struct glint_selftest_finding *finding, struct glint_error *err) {
    const struct picture_ties ties = {c->bound, slack};
    const uint32_t step = pictures->context->quick ? 4 : 1;
    bool ok = true;
    for (uint32_t i = 0; ok && (i == 0 || i < c->variants); i += step) {
        struct open_box box = c->box;
        struct picture found = {0};
        if (c->vary) c->vary(i, &box);
        ok = replay_box(pictures, kind, &box, &found, err);
        if (ok) pictures_compare(expected, &found, NULL, &ties, finding);
        free(found.values);
    }
    texture_filter_limit_ties(finding);
    return ok;
}

bool convention_set_run(const struct case_context *context, const struct convention_set *kind, const bool *selected,
                        struct glint_selftest_finding *findings, struct glint_error *err) {
    struct pictures pictures = {0};
    struct picture expected = {0};
    double slack = 0;
    bool any = false;
    for (size_t i = 0; i < kind->count; i++) any = any || selected[i];
    if (!any) return true;
    bool ok = (kind->preset ? pictures_begin_preset(&pictures, context, kind->preset, err)
                            : pictures_begin(&pictures, context, "", err)) &&
              replay_box(&pictures, kind, &kind->usual, &expected, err) &&
              texture_filter_slack(context, pictures.capture, &slack, err);
    for (size_t i = 0; ok && i < kind->count; i++)
        if (selected[i]) ok = run_convention(&pictures, kind, &kind->cases[i], slack, &expected, &findings[i], err);
    free(expected.values);
    pictures_end(&pictures);
    return ok;
}
