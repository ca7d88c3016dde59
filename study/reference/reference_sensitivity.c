/* Sensitivity of the reference to ASSUMED parameters: compares references with changed parameters that use the same random numbers. */
#include "question.h"
#include "reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void add_row(struct glint_reference_sensitivity *sensitivity, const struct glint_pass *pass,
                    const struct glint_row *row, double value, double factor) {
    if (sensitivity->count == GLINT_ASSUMPTIONS_MAX) return;
    struct glint_reference_assumption *added = &sensitivity->rows[sensitivity->count++];
    double tried = value * factor;
    if (row->type != GLINT_VALUE_FLOAT) tried = floor(tried + 0.5);
    *added = (struct glint_reference_assumption){.pass = pass, .row = row, .value = value, .tried = tried, .ran = true};
    if (tried == value) snprintf(added->reason, sizeof added->reason, "it is 0");
    else if (tried < row->lowest || tried > row->highest)
        snprintf(added->reason, sizeof added->reason, "outside %g to %g", row->lowest, row->highest);
    added->ran = !added->reason[0];
}

/* Assumptions of other effects do not change the result. */
static void list_assumptions(const struct glint_reference *reference, struct glint_reference_sensitivity *sensitivity) {
    const struct glint_pipeline *pipeline = reference->pipeline;
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        if (!study_concerns(reference->effect, pass)) continue;
        for (size_t r = 0; r < pass->row_count; r++) {
            if (!glint_row_is_parameter(&pass->rows[r]) || !glint_pass_assumes(pass, &pass->rows[r])) continue;
            const double value = glint_pipeline_value(pipeline, pass, &pass->rows[r]);
            add_row(sensitivity, pass, &pass->rows[r], value, 0.5);
            if (value != 0) add_row(sensitivity, pass, &pass->rows[r], value, 2);
        }
    }
}

static bool trace_rounds(const struct glint_reference *reference, struct glint_pipeline *pipeline, uint32_t rays,
                         struct glint_progress_part part, struct halves *halves, struct glint_error *err) {
    const uint32_t rounds = (rays + GLINT_REFERENCE_ROUND - 1) / GLINT_REFERENCE_ROUND;
    part.share /= rounds;
    for (uint32_t r = 0; r < rounds; r++, part.done += part.share)
        if (!halves_trace(halves, reference, pipeline, glint_report_part, &part, err)) return false;
    return true;
}

/* Replaces the halves of `changed` by their differences D to those of `base`. The mean change is (D_A + D_B)/2 and its noise (D_A - D_B)/2. The
   difference of their squares is D_A · D_B, which noise does not bias since that of both halves is independent. */
static bool compare_halves(const struct glint_reference *reference, const struct halves *base, struct halves *changed,
                           struct glint_reference_assumption *row, struct glint_error *err) {
    const uint32_t judged = reference->judged;
    struct glint_pixels mean = {0}, before = {0};
    struct glint_image_errors noise, change;
    bool ok = reference_mean(changed, judged, &mean, NULL, err) && reference_mean(base, judged, &before, NULL, err) &&
              glint_study_image(&mean, &before, judged, reference->labels, NULL, &change, err);
    for (int h = 0; ok && h < 2; h++)
        for (size_t i = 0; i < (size_t)mean.width * mean.height * mean.components; i++)
            changed->of[h].values[i] -= base->of[h].values[i];
    ok = ok && glint_study_image(&changed->of[0], &changed->of[1], judged, reference->labels, NULL, &noise, err);
    for (int k = 0; ok && k < GLINT_CLASS_COUNT; k++) {
        const double all = change.of[k].rmse, own = 0.5 * noise.of[k].rmse;
        struct glint_reference_change *found = &row->of[k];
        *found = (struct glint_reference_change){
            .mean = change.of[k].mean, .rmse = sqrt(fmax(0, all * all - own * own)), .noise = own};
        if (change.of[k].truth_mean > 0) found->relative = found->rmse / change.of[k].truth_mean;
    }
    glint_pixels_finish(&mean);
    glint_pixels_finish(&before);
    return ok;
}

static bool trace_assumption(const struct glint_reference *reference, uint32_t rays, const struct halves *base,
                             struct glint_reference_assumption *row, struct glint_progress_part *part,
                             struct glint_error *err) {
    char assignment[192];
    struct halves halves = {0};
    struct glint_pipeline *pipeline = glint_pipeline_copy(reference->pipeline, err);
    snprintf(assignment, sizeof assignment, "%s.%s=%.17g", row->pass->slot, row->row->name, row->tried);
    snprintf(part->text, sizeof part->text, "%s %g", row->row->name, row->tried);
    bool ok = pipeline && glint_pipeline_set(pipeline, assignment, err) &&
              trace_rounds(reference, pipeline, rays, *part, &halves, err) &&
              compare_halves(reference, base, &halves, row, err);
    halves_finish(&halves);
    glint_pipeline_destroy(&pipeline);
    return ok;
}

/* Stores the result, also in the folder. */
static bool store_sensitivity(struct glint_reference *reference, const struct glint_reference_sensitivity *sensitivity,
                              struct glint_error *err) {
    json_t *found = reference_sensitivity_json(reference->effect, sensitivity);
    bool ok = found != NULL;
    if (ok) {
        json_decref(reference->sensitivity);
        reference->sensitivity = found;
        if (!reference->folder || !reference->record) return true;
        ok = json_object_set_new(reference->record, "reference", reference_json(reference)) == 0;
    }
    return ok ? reference_save(reference, err) : glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory");
}

bool glint_reference_sensitivity(struct glint_reference *reference, uint32_t rays, glint_progress progress, void *user,
                                 struct glint_reference_sensitivity *sensitivity, struct glint_error *err) {
    struct glint_progress_part part = {.progress = progress, .user = user, .text = "as it is"};
    struct halves base = {0};
    size_t runs = 1;
    *sensitivity = (struct glint_reference_sensitivity){0};
    list_assumptions(reference, sensitivity);
    for (size_t i = 0; i < sensitivity->count; i++) runs += sensitivity->rows[i].ran;
    part.share = 1 / (double)runs;
    bool ok = (rays > 0 && rays <= GLINT_REFERENCE_RAYS_MAX) ||
              glint_fail(err, GLINT_ERROR_USAGE, "rays: expected 1 to %d, found %u", GLINT_REFERENCE_RAYS_MAX, rays);
    ok = ok && trace_rounds(reference, reference->pipeline, rays, part, &base, err);
    for (size_t i = 0; ok && i < sensitivity->count; i++) {
        if (!sensitivity->rows[i].ran) continue;
        part.done += part.share;
        ok = trace_assumption(reference, rays, &base, &sensitivity->rows[i], &part, err);
    }
    sensitivity->rays = 2 * base.rays;
    halves_finish(&base);
    return ok && store_sensitivity(reference, sensitivity, err);
}
