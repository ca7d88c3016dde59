/* Traces the rays of both halves and estimates the noise from their difference. */
#include "reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void halves_finish(struct halves *halves) {
    for (int h = 0; h < 2; h++) {
        glint_pixels_finish(&halves->of[h]);
        glint_pixels_finish(&halves->batch[h]);
    }
    *halves = (struct halves){0};
}

/* An interruption should lose little work. A software device takes seconds or minutes for a ray of all pixels. A GPU is faster with several rays in one
   run, or with fewer for pictures above 960 × 540. */
static uint32_t rays_at_once(const struct glint_reference *reference) {
    const struct glint_part_info *part = glint_capture_find(reference->capture, GLINT_PART_GBUFFER);
    uint32_t rays = GLINT_REFERENCE_BATCH;
    if (reference->at_once) return reference->at_once;
    if (glint_device_get_info(glint_replay_device(reference->replay))->is_cpu) return 1;
    for (size_t pixels = (size_t)part->width * part->height; rays > 1 && pixels > 960 * 540; pixels /= 2) rays /= 2;
    return rays;
}

/* The half whose rays come next. */
static int next_half(const struct halves *halves) {
    return halves->batched[0] == GLINT_REFERENCE_BATCH;
}

uint32_t halves_next(const struct halves *halves, const struct glint_reference *reference) {
    const uint32_t left = GLINT_REFERENCE_BATCH - halves->batched[next_half(halves)], most = rays_at_once(reference);
    return most < left ? most : left;
}

static bool trace_rays(const struct glint_reference *reference, struct glint_pipeline *pipeline, uint32_t first,
                       uint32_t count, struct glint_pixels *pixels, glint_progress progress, void *user,
                       struct glint_error *err) {
    const char *const result[] = {reference->result->name, NULL};
    const struct glint_replay_options options = {
        .outputs = result, .all = reference->all, .float_precision = true, .keep_bytes = reference->keep_bytes};
    char rays[64], from[64];
    snprintf(rays, sizeof rays, "pipeline.rays=%u", count);
    snprintf(from, sizeof from, "pipeline.first_ray=%u", first);
    return glint_pipeline_set(pipeline, rays, err) && glint_pipeline_set(pipeline, from, err) &&
           glint_replay_run(reference->replay, pipeline, &options, progress, user, err) &&
           glint_study_result(reference->replay, reference->effect, pixels, err);
}

static size_t count_invalid(const struct glint_pixels *pixels) {
    size_t invalid = 0;
    for (size_t i = 0; i < (size_t)pixels->width * pixels->height; i++) {
        const float *value = pixels->values + i * pixels->components;
        bool finite = true;
        for (uint32_t k = 0; k < pixels->components; k++) finite = finite && isfinite(value[k]);
        invalid += !finite;
    }
    return invalid;
}

/* Adds the mean of `count` more values to the mean of `before` values. */
static void add_mean(struct glint_pixels *mean, uint32_t before, struct glint_pixels *more, uint32_t count) {
    if (before == 0) {
        glint_pixels_finish(mean);
        *mean = *more;
        *more = (struct glint_pixels){0};
        return;
    }
    const double part = (double)count / (before + count);
    for (size_t i = 0; i < (size_t)mean->width * mean->height * mean->components; i++) {
        const double value = (double)mean->values[i];
        mean->values[i] = (float)(value + ((double)more->values[i] - value) * part);
    }
    glint_pixels_finish(more);
}

bool halves_run(struct halves *halves, const struct glint_reference *reference, struct glint_pipeline *pipeline,
                glint_progress progress, void *user, struct glint_error *err) {
    const int half = next_half(halves);
    const uint32_t begun = halves->batched[half], count = halves_next(halves, reference);
    const uint32_t first = (uint32_t)half * GLINT_REFERENCE_SECOND + halves->rays + begun;
    struct glint_pixels more = {0};
    if (!trace_rays(reference, pipeline, first, count, &more, progress, user, err)) return false;
    const size_t invalid = count_invalid(&more);
    if (invalid) {
        glint_pixels_finish(&more);
        return glint_fail(err, GLINT_ERROR_FORMAT, "reference: the %s is NaN or infinite in %zu pixels",
                          reference->effect->noun, invalid);
    }
    add_mean(&halves->batch[half], begun, &more, count);
    halves->batched[half] += count;
    if (halves->batched[1] < GLINT_REFERENCE_BATCH) return true;
    for (int h = 0; h < 2; h++) {
        add_mean(&halves->of[h], halves->rays, &halves->batch[h], GLINT_REFERENCE_BATCH);
        halves->batched[h] = 0;
    }
    halves->rays += GLINT_REFERENCE_BATCH;
    return true;
}

bool halves_trace(struct halves *halves, const struct glint_reference *reference, struct glint_pipeline *pipeline,
                  glint_progress progress, void *user, struct glint_error *err) {
    const double round = GLINT_REFERENCE_ROUND;
    do {
        const double done = halves->batched[0] + halves->batched[1];
        struct glint_progress_part part = {progress, user, done / round, halves_next(halves, reference) / round, ""};
        if (!halves_run(halves, reference, pipeline, glint_report_part, &part, err)) return false;
    } while (halves->batched[0]);
    return true;
}

bool reference_mean(const struct halves *halves, uint32_t judged, struct glint_pixels *mean, float **error,
                    struct glint_error *err) {
    const struct glint_pixels *a = &halves->of[0], *b = &halves->of[1];
    const size_t pixels = (size_t)a->width * a->height;
    *mean = (struct glint_pixels){a->width, a->height, a->components, NULL};
    mean->values = malloc(pixels * a->components * sizeof *mean->values + 1);
    if (error) *error = calloc(pixels + 1, sizeof **error);
    if (!mean->values || (error && !*error)) return glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory");
    for (size_t i = 0; i < pixels; i++) {
        double off2 = 0, value2 = 0;
        for (uint32_t k = 0; k < a->components; k++) {
            const size_t at = i * a->components + k;
            const double of_a = (double)a->values[at], of_b = (double)b->values[at];
            mean->values[at] = (float)(0.5 * (of_a + of_b));
            if (k >= judged) continue; /* alpha */
            off2 += 0.25 * (of_a - of_b) * (of_a - of_b);
            value2 += 0.25 * (of_a + of_b) * (of_a + of_b);
        }
        if (error && value2 > 0) (*error)[i] = (float)sqrt(off2 / value2);
    }
    return true;
}

bool reference_measure(struct glint_reference *reference, struct glint_error *err) {
    const struct halves *halves = &reference->halves;
    struct glint_image_errors errors;
    if (!glint_study_image(&halves->of[0], &halves->of[1], reference->judged, reference->labels, NULL, &errors, err))
        return false;
    reference->state.rays = 2 * halves->rays;
    for (int k = 0; k < GLINT_CLASS_COUNT; k++) {
        const struct glint_image_error *e = &errors.of[k];
        struct glint_reference_noise *noise = &reference->state.noise[k];
        *noise = (struct glint_reference_noise){
            .pixels = e->pixels, .mean = e->truth_mean + 0.5 * e->mean, .error = 0.5 * e->rmse};
        noise->relative = noise->error > 0 ? noise->error / fabs(noise->mean) : 0;
    }
    return true;
}
