/* Rays of the reference in two halves, and the noise that is left between them. */
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

/* Part of a round, as its caller sees the whole. */
struct step {
    glint_progress progress;
    void *user;
    double done, share;
};
static bool report_step(void *user, const char *what, double done) {
    struct step *step = user;
    return !step->progress || step->progress(step->user, what, step->done + step->share * done);
}

static bool trace_batch(struct halves *halves, int half, const struct glint_reference *reference,
                        struct glint_pipeline *pipeline, struct step *step, struct glint_error *err) {
    static const char *const reflection[] = {"reflection", NULL};
    const struct glint_replay_options options = {
        .outputs = reflection, .all = reference->all, .float_precision = true, .keep_bytes = reference->keep_bytes};
    char rays[64], first[64];
    snprintf(rays, sizeof rays, "pipeline.rays=%d", GLINT_REFERENCE_BATCH);
    snprintf(first, sizeof first, "pipeline.first_ray=%u", (uint32_t)half * GLINT_REFERENCE_SECOND + halves->rays);
    glint_pixels_finish(&halves->batch[half]);
    return glint_pipeline_set(pipeline, rays, err) && glint_pipeline_set(pipeline, first, err) &&
           glint_replay_run(reference->replay, pipeline, &options, report_step, step, err) &&
           glint_study_reflection(reference->replay, &halves->batch[half], err);
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

/* The mean goes on from the mean of n batches, so that what is kept is what is shown. */
static void add_batch(struct halves *halves, int half) {
    struct glint_pixels *mean = &halves->of[half], *batch = &halves->batch[half];
    const double n = halves->rays / GLINT_REFERENCE_BATCH + 1;
    if (!mean->values) {
        *mean = *batch;
        *batch = (struct glint_pixels){0};
        return;
    }
    for (size_t i = 0; i < (size_t)mean->width * mean->height * mean->components; i++) {
        const double before = (double)mean->values[i];
        mean->values[i] = (float)(before + ((double)batch->values[i] - before) / n);
    }
}

bool halves_trace(struct halves *halves, const struct glint_reference *reference, struct glint_pipeline *pipeline,
                  glint_progress progress, void *user, struct glint_error *err) {
    for (int h = 0; h < 2; h++) {
        struct step step = {.progress = progress, .user = user, .done = 0.5 * h, .share = 0.5};
        if (!trace_batch(halves, h, reference, pipeline, &step, err)) return false;
        const size_t invalid = count_invalid(&halves->batch[h]);
        if (invalid)
            return glint_fail(err, GLINT_ERROR_FORMAT, "reference: the reflection is NaN or infinite in %zu pixels",
                              invalid);
    }
    for (int h = 0; h < 2; h++) add_batch(halves, h);
    halves->rays += GLINT_REFERENCE_BATCH;
    return true;
}

bool reference_mean(const struct halves *halves, struct glint_pixels *mean, float **error, struct glint_error *err) {
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
            if (k >= 3) continue; /* not of the colour */
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
    if (!glint_study_image(&halves->of[0], &halves->of[1], 3, reference->surfaces, NULL, &errors, err)) return false;
    reference->state.rays = 2 * halves->rays;
    for (int k = 0; k < GLINT_SURFACE_COUNT; k++) {
        const struct glint_image_error *e = &errors.of[k];
        struct glint_reference_noise *noise = &reference->state.noise[k];
        *noise = (struct glint_reference_noise){
            .pixels = e->pixels, .mean = e->truth_mean + 0.5 * e->mean, .error = 0.5 * e->rmse};
        noise->relative = noise->error > 0 ? noise->error / fabs(noise->mean) : 0;
    }
    return true;
}
