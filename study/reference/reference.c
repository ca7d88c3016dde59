/* The reference: creates or resumes it, traces rounds of rays, stores it. */
#include "reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double SAVE_SECONDS = 5; /* the work that a crash may lose */

static bool any_judged(const struct glint_reference *reference) {
    const struct glint_part_info *part = glint_capture_find(reference->capture, GLINT_PART_GBUFFER);
    for (size_t i = 0; i < (size_t)part->width * part->height; i++)
        if (reference->labels[i] != GLINT_CLASS_NONE) return true;
    return false;
}

static bool find_result(struct glint_reference *reference, const struct glint_effect *effect,
                        const struct glint_pipeline *pipeline, struct glint_error *err) {
    size_t effects;
    reference->effect = effect ? effect : glint_effects(&effects);
    reference->result = glint_study_made(pipeline, reference->effect);
    if (!reference->result)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: no pass of it makes %s", glint_pipeline_name(pipeline),
                          reference->effect->noun);
    study_split_channels(reference->result->channels, &reference->channels);
    reference->judged = glint_effect_channels(reference->effect, NULL);
    return true;
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
    reference->at_once = options ? options->at_once : 0;
    bool ok = find_result(reference, options ? options->effect : NULL, pipeline, err) &&
              (reference->pipeline = glint_pipeline_copy(pipeline, err)) != NULL &&
              (reference->labels = glint_study_labels(capture, reference->effect, err)) != NULL;
    if (ok && !any_judged(reference))
        ok = glint_fail(err, GLINT_ERROR_FORMAT, "%s: %s, so there is no %s to trace", glint_capture_path(capture),
                        reference->effect->judged == GLINT_JUDGED_REFLECTING ? "nothing in it reflects"
                                                                             : "it shows nothing but sky",
                        reference->effect->noun);
    if (ok && options && options->folder) {
        reference->folder = strdup(options->folder);
        reference->cache = options->cache ? strdup(options->cache) : NULL;
        ok = ((reference->folder && (reference->cache || !options->cache)) ||
              glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory")) &&
             reference_settings(reference, err) && reference_resume(reference, options->overwrite, err);
    }
    if (reference->folder) reference->state.kept = reference->state.rays + reference->state.begun;
    if (!ok) glint_reference_destroy(&reference);
    return reference;
}

void glint_reference_continue(struct glint_reference *reference, struct glint_replay *replay) {
    reference->replay = replay;
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
    glint_folder_unlock(&reference->lock);
    free(reference->labels);
    free(reference->folder);
    free(reference->cache);
    free(reference);
}

static uint32_t count_rays(const struct glint_reference_state *state) {
    return state->rays + state->begun;
}

/* The expected number of rays, since noise falls with the square root of that number. */
static double rays_expected(const struct glint_reference_state *state, uint32_t rays, double noise) {
    const double now = state->noise[0].relative;
    if (!(noise > 0) || state->rays == 0) return rays;
    return fmin(rays, state->rays * fmax(1, now * now / (noise * noise)));
}

static bool is_reached(const struct glint_reference_state *state, uint32_t rays, double noise) {
    return state->rays >= rays || (noise > 0 && state->rays > 0 && state->noise[0].relative <= noise);
}

static void describe_part(struct glint_progress_part *part, const struct glint_reference_state *state, uint32_t first,
                          double expected) {
    const double todo = fmax(expected - first, 1);
    const int length = snprintf(part->text, sizeof part->text, "%u of %.0f rays", count_rays(state),
                                ceil(expected / GLINT_REFERENCE_ROUND) * GLINT_REFERENCE_ROUND);
    if (state->rays)
        snprintf(part->text + length, sizeof part->text - (size_t)length, ", noise %.3g %%",
                 100 * state->noise[0].relative);
    part->done = (count_rays(state) - first) / todo;
    part->share = 1 / todo;
}

/* Traces the next rays, and measures the noise if they complete a round. */
static bool trace_part(struct glint_reference *reference, struct glint_progress_part *part, struct glint_error *err) {
    struct glint_reference_state *state = &reference->state;
    struct halves *halves = &reference->halves;
    const uint32_t before = halves->rays;
    const double start = glint_now_seconds();
    part->share *= halves_next(halves, reference);
    bool ok = halves_run(halves, reference, reference->pipeline, glint_report_part, part, err);
    state->begun = halves->batched[0] + halves->batched[1];
    if (ok) state->seconds += glint_now_seconds() - start;
    if (ok && halves->rays != before)
        ok = reference_measure(reference, err) && (!reference->folder || reference_note(reference, err));
    return ok;
}

/* *complete is the number of rays of the complete reference in the folder. */
static bool save_reference(struct glint_reference *reference, uint32_t *complete, struct glint_error *err) {
    struct glint_reference_state *state = &reference->state;
    if (state->rays != *complete && !reference_save(reference, err)) return false;
    *complete = state->kept = state->rays;
    if (state->begun && !reference_save_round(reference, err)) return false;
    state->kept += state->begun;
    return true;
}

bool glint_reference_trace(struct glint_reference *reference, uint32_t rays, double noise, glint_progress progress,
                           void *user, struct glint_error *err) {
    struct glint_reference_state *state = &reference->state;
    struct glint_progress_part part = {.progress = progress, .user = user};
    const uint32_t first = count_rays(state),
                   target = (rays + GLINT_REFERENCE_ROUND - 1) / GLINT_REFERENCE_ROUND * GLINT_REFERENCE_ROUND;
    /* How many rays a limit of noise takes depends on where tracing began. */
    const bool cached = reference->cache && !(noise > 0);
    uint32_t complete = state->rays;
    double saved = glint_now_seconds();
    bool unsaved = false, finished = false, look = cached;
    bool ok = rays <= GLINT_REFERENCE_RAYS_MAX ||
              glint_fail(err, GLINT_ERROR_USAGE, "rays: expected at most %d, found %u", GLINT_REFERENCE_RAYS_MAX, rays);
    while (ok && !is_reached(state, rays, noise)) {
        if (look && reference_find_cached(reference, target)) {
            unsaved = true;
            break;
        }
        const uint32_t before = count_rays(state);
        describe_part(&part, state, first, rays_expected(state, rays, noise));
        ok = trace_part(reference, &part, err);
        unsaved = unsaved || (reference->folder && count_rays(state) != before);
        finished = ok && is_reached(state, rays, noise);
        look = false;
        if (!ok || !unsaved || glint_now_seconds() - saved < SAVE_SECONDS) continue;
        ok = save_reference(reference, &complete, err);
        saved = glint_now_seconds();
        unsaved = !ok;
        look = cached; /* another process may have finished it meanwhile */
    }
    /* What interrupted it is the error; state->kept says what was saved nevertheless. */
    if (unsaved) ok = save_reference(reference, &complete, ok ? err : NULL) && ok;
    if (ok && finished && cached) reference_store_cached(reference);
    return ok;
}

const struct glint_reference_state *glint_reference_state(const struct glint_reference *reference) {
    return &reference->state;
}

bool glint_reference_pixels(const struct glint_reference *reference, struct glint_pixels *pixels, float **error,
                            struct glint_error *err) {
    *pixels = (struct glint_pixels){0};
    if (error) *error = NULL;
    if (reference->halves.rays == 0) return glint_fail(err, GLINT_ERROR_USAGE, "the reference has no rays yet");
    return reference_mean(&reference->halves, reference->judged, pixels, error, err);
}

bool glint_study_reference_bias(const struct glint_pixels *reference, const float *reference_error,
                                const struct glint_pixels *truth, const float *truth_error, const uint8_t *labels,
                                struct glint_image_errors *errors, struct glint_error *err) {
    const size_t pixels = (size_t)truth->width * truth->height;
    if (reference->width != truth->width || reference->height != truth->height)
        return glint_study_image(reference, truth, truth->components, labels, truth_error, errors,
                                 err); /* fails with a message */
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
        if (isinf(of_truth)) both[i] = INFINITY; /* the truth is unknown there */
        else if (truth2 > 0) both[i] = (float)sqrt(of_truth * of_truth + of_own * of_own * own2 / truth2);
    }
    bool ok = glint_study_image(reference, truth, truth->components, labels, both, errors, err);
    free(both);
    return ok;
}
