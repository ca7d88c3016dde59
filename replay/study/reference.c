/* Rays of the reference, round by round, and the noise that is left. */
#include "reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "progress.h"
#include "timing.h"

static const double SAVE_SECONDS = 5; /* what an end without warning may cost */

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

static bool any_reflects(const struct glint_reference *reference) {
    const struct glint_part_info *part = glint_capture_find(reference->capture, "gbuffer");
    for (size_t i = 0; i < (size_t)part->width * part->height; i++)
        if (reference->surfaces[i] != GLINT_SURFACE_NONE) return true;
    return false;
}

struct glint_reference *glint_reference_create(struct glint_replay *replay, struct glint_capture *capture,
                                               const struct glint_pipeline *pipeline,
                                               const struct glint_reference_options *options, struct glint_error *err) {
    struct glint_reference *reference = calloc(1, sizeof *reference);
    if (!reference) {
        glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory");
        return NULL;
    }
    reference->replay = replay;
    reference->capture = capture;
    reference->all = options && options->all;
    reference->keep_bytes = options ? options->keep_bytes : 0;
    bool ok = (reference->pipeline = glint_pipeline_copy(pipeline, err)) != NULL &&
              (reference->surfaces = glint_study_surfaces(capture, err)) != NULL;
    if (ok && !any_reflects(reference))
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: nothing in it reflects, so there is no reflection to trace",
                        glint_capture_path(capture));
    if (ok && options && options->folder) {
        reference->folder = strdup(options->folder);
        ok = (reference->folder || glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory")) &&
             reference_settings(reference, err) && reference_resume(reference, options->anew, err);
    }
    if (!ok) glint_reference_destroy(&reference);
    return reference;
}

void glint_reference_destroy(struct glint_reference **pointer) {
    struct glint_reference *reference = *pointer;
    *pointer = NULL;
    if (!reference) return;
    halves_finish(&reference->halves);
    glint_pipeline_destroy(&reference->pipeline);
    json_decref(reference->settings);
    json_decref(reference->sensitivity);
    json_decref(reference->record);
    free(reference->surfaces);
    free(reference->folder);
    free(reference);
}

/* How many rays it will take: noise falls with the root of their number. */
static double rays_expected(const struct glint_reference_state *state, uint32_t rays, double noise) {
    const double now = state->noise[0].relative;
    if (!(noise > 0) || state->rays == 0) return rays;
    return fmin(rays, state->rays * fmax(1, now * now / (noise * noise)));
}

static bool reached(const struct glint_reference_state *state, uint32_t rays, double noise) {
    return state->rays >= rays || (noise > 0 && state->rays > 0 && state->noise[0].relative <= noise);
}

struct round {
    glint_progress progress;
    void *user;
    char text[64];
    double done, share;
};
static bool report_round(void *user, const char *what, double done) {
    struct round *round = user;
    (void)what;
    return !round->progress || round->progress(round->user, round->text, round->done + round->share * done);
}

bool glint_reference_trace(struct glint_reference *reference, uint32_t rays, double noise, glint_progress progress,
                           void *user, struct glint_error *err) {
    struct glint_reference_state *state = &reference->state;
    const uint32_t first = state->rays;
    double saved = now_seconds();
    bool ok = rays <= GLINT_REFERENCE_RAYS_MAX ||
              glint_fail(err, GLINT_ERROR_USAGE, "rays: expected at most %d, found %u", GLINT_REFERENCE_RAYS_MAX, rays);
    bool unsaved = false;
    while (ok && !reached(state, rays, noise)) {
        const double start = now_seconds(), todo = fmax(rays_expected(state, rays, noise) - first, 1);
        struct round round = {.progress = progress, .user = user, .done = (state->rays - first) / todo};
        round.share = GLINT_REFERENCE_ROUND / todo;
        snprintf(round.text, sizeof round.text, "%u rays", state->rays);
        if (state->rays)
            snprintf(round.text, sizeof round.text, "%u rays, noise %.3g %%", state->rays,
                     100 * state->noise[0].relative);
        ok = halves_trace(&reference->halves, reference, reference->pipeline, report_round, &round, err) &&
             reference_measure(reference, err) && (!reference->folder || reference_note(reference, err));
        if (!ok) break;
        state->seconds += now_seconds() - start;
        unsaved = reference->folder != NULL;
        if (!unsaved || now_seconds() - saved < SAVE_SECONDS) continue;
        ok = reference_save(reference, err);
        saved = now_seconds();
        unsaved = !ok;
    }
    if (!unsaved) return ok;
    return reference_save(reference, ok ? err : NULL) && ok;
}

const struct glint_reference_state *glint_reference_state(const struct glint_reference *reference) {
    return &reference->state;
}

bool glint_reference_pixels(const struct glint_reference *reference, struct glint_pixels *pixels, float **error,
                            struct glint_error *err) {
    *pixels = (struct glint_pixels){0};
    if (error) *error = NULL;
    if (reference->halves.rays == 0) return glint_fail(err, GLINT_ERROR_USAGE, "the reference has no rays yet");
    return reference_mean(&reference->halves, pixels, error, err);
}

bool glint_study_missing(const struct glint_pixels *reference, const float *reference_error,
                         const struct glint_pixels *truth, const float *truth_error, const uint8_t *surfaces,
                         struct glint_image_errors *errors, struct glint_error *err) {
    const size_t pixels = (size_t)truth->width * truth->height;
    if (reference->width != truth->width || reference->height != truth->height)
        return glint_study_image(reference, truth, 3, surfaces, truth_error, errors, err); /* which fails */
    float *both = calloc(pixels + 1, sizeof *both);
    if (!both) return glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory");
    for (size_t i = 0; i < pixels; i++) {
        double truth2 = 0, own2 = 0;
        for (uint32_t k = 0; k < 3; k++) {
            const double t = (double)truth->values[i * truth->components + k],
                         r = (double)reference->values[i * reference->components + k];
            truth2 += t * t;
            own2 += r * r;
        }
        const double of_truth = truth_error ? (double)truth_error[i] : 0,
                     of_own = reference_error ? (double)reference_error[i] : 0;
        if (truth2 > 0) both[i] = (float)sqrt(of_truth * of_truth + of_own * of_own * own2 / truth2);
    }
    bool ok = glint_study_image(reference, truth, 3, surfaces, both, errors, err);
    free(both);
    return ok;
}
