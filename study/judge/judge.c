/* Measures errors and costs of pipelines on one capture, all with one replay. */
#include "glint/judge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "targets.h"
#include "no_memory.h"

/* The time of a pass in the current round. */
struct measured {
    uint64_t key, ns;
};

struct glint_judge {
    struct glint_device *device;
    struct glint_judge_options options;
    struct glint_replay *replay;
    struct glint_capture *capture;
    uint8_t *labels;
    size_t pixels;
    struct target *targets;
    uint32_t round;
    struct measured *measured;
    size_t measured_count;
    const char *const *skip, *const *force;
};

const char *glint_target_name(enum glint_target target) {
    static const char *const names[GLINT_TARGET_COUNT] = {"reference", "truth"};
    return target < GLINT_TARGET_COUNT ? names[target] : NULL;
}

struct glint_judge *glint_judge_create(struct glint_device *device, const struct glint_judge_options *options,
                                       struct glint_error *err) {
    const uint64_t most = (uint64_t)4 << 30, quarter = glint_device_get_info(device)->memory_bytes / 4;
    struct glint_judge *judge = calloc(1, sizeof *judge);
    if (!judge) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    judge->device = device;
    judge->options = *options;
    size_t effects;
    if (!judge->options.effect) judge->options.effect = glint_effects(&effects);
    if (!judge->options.keep_bytes) judge->options.keep_bytes = quarter < most ? quarter : most;
    judge->round = 1;
    if (!(judge->replay = glint_replay_create(device, err))) glint_judge_destroy(&judge);
    return judge;
}

static void unload_capture(struct glint_judge *judge) {
    targets_finish(&judge->targets);
    free(judge->labels);
    judge->labels = NULL;
    judge->capture = NULL;
    judge->measured_count = 0;
}

void glint_judge_destroy(struct glint_judge **pointer) {
    struct glint_judge *judge = *pointer;
    *pointer = NULL;
    if (!judge) return;
    unload_capture(judge);
    free(judge->measured);
    if (judge->replay) glint_replay_destroy(&judge->replay);
    free(judge);
}

bool glint_judge_load(struct glint_judge *judge, struct glint_capture *capture, struct glint_error *err) {
    unload_capture(judge);
    if (!glint_replay_load(judge->replay, capture, err)) return false;
    if (!capture) return true;
    const struct glint_part_info *gbuffer = glint_capture_find(capture, GLINT_PART_GBUFFER);
    judge->capture = capture;
    judge->pixels = (size_t)gbuffer->width * gbuffer->height;
    return (judge->labels = glint_study_labels(capture, judge->options.effect, err)) != NULL;
}

void glint_judge_leave(struct glint_judge *judge) {
    glint_replay_destroy(&judge->replay);
    judge->measured_count = 0;
}

bool glint_judge_return(struct glint_judge *judge, struct glint_error *err) {
    return (judge->replay = glint_replay_create(judge->device, err)) &&
           glint_replay_load(judge->replay, judge->capture, err);
}

void glint_judge_override(struct glint_judge *judge, const char *const *skip, const char *const *force) {
    judge->skip = skip;
    judge->force = force;
}

struct glint_replay *glint_judge_replay(struct glint_judge *judge) {
    return judge->replay;
}
struct glint_capture *glint_judge_capture(const struct glint_judge *judge) {
    return judge->capture;
}
const struct glint_effect *glint_judge_effect(const struct glint_judge *judge) {
    return judge->options.effect;
}
const uint8_t *glint_judge_labels(const struct glint_judge *judge) {
    return judge->labels;
}

static const struct target *get_target(struct glint_judge *judge, enum glint_target kind,
                                       const struct glint_pipeline *pipeline, glint_progress progress, void *user,
                                       struct glint_error *err) {
    const struct target_request request = {&judge->options, judge->replay, judge->capture, pipeline, progress, user};
    return targets_get(&judge->targets, kind, &request, err);
}

const struct glint_pixels *glint_judge_target(struct glint_judge *judge, enum glint_target kind,
                                              const struct glint_pipeline *pipeline, const float **error,
                                              glint_progress progress, void *user, struct glint_error *err) {
    const struct target *target = get_target(judge, kind, pipeline, progress, user, err);
    if (!target) return NULL;
    *error = target->error;
    return &target->pixels;
}

void glint_verdict_finish(struct glint_verdict *verdict) {
    for (int k = 0; k < GLINT_TARGET_COUNT; k++) glint_metric_table_finish(&verdict->errors[k]);
    glint_pixels_finish(&verdict->result);
    free(verdict->coverage);
    free(verdict->passes);
    *verdict = (struct glint_verdict){0};
}

/* Reads the result and its coverage. Where the plan dropped the passes that make it, it is 0 with no coverage. */
static bool read_result(struct glint_judge *judge, struct glint_verdict *verdict, struct glint_error *err) {
    const struct glint_part_info *gbuffer = glint_capture_find(judge->capture, GLINT_PART_GBUFFER);
    struct glint_error own = {0};
    const struct glint_effect *effect = judge->options.effect;
    if (glint_study_result(judge->replay, effect, &verdict->result, &own))
        return (verdict->coverage = glint_study_coverage(judge->replay, effect, &verdict->result, err)) != NULL;
    if (own.code != GLINT_ERROR_USAGE) return glint_fail(err, own.code, "%s", own.message);
    const uint32_t channels = glint_effect_channels(effect, NULL);
    verdict->result = (struct glint_pixels){gbuffer->width, gbuffer->height, channels,
                                            calloc(channels * judge->pixels, sizeof(float))};
    verdict->coverage = calloc(judge->pixels, 1);
    return (verdict->result.values && verdict->coverage) || no_memory(err, "judge");
}

static bool read_passes(struct glint_judge *judge, struct glint_verdict *verdict, struct glint_error *err) {
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(judge->replay, &count);
    if (!(verdict->passes = calloc(count + 1, sizeof *verdict->passes))) return no_memory(err, "judge");
    for (size_t i = 0; i < count; i++) {
        struct glint_verdict_pass *pass = &verdict->passes[verdict->pass_count++];
        *pass = (struct glint_verdict_pass){.pass = results[i].pass,
                                            .ran = results[i].ran,
                                            .cached_work = results[i].cached_work,
                                            .executed = results[i].ran && !results[i].cached && !results[i].pass->host};
        memcpy(pass->reason, results[i].reason, sizeof pass->reason);
    }
    return true;
}

static bool compare_with_target(struct glint_judge *judge, const struct target *target, struct glint_verdict *verdict,
                                struct glint_error *err) {
    const struct glint_classes classes = glint_study_classes_of(judge->options.effect, judge->labels);
    const char *channels;
    glint_effect_channels(judge->options.effect, &channels);
    const struct glint_metric_options options = {.metrics = judge->options.metrics,
                                                 .found_channels = channels,
                                                 .truth_channels = channels,
                                                 .mask = judge->labels,
                                                 .classes = &classes,
                                                 .class_sets = 1,
                                                 .truth_error = target->error,
                                                 .resamples = judge->options.resamples,
                                                 .seed = judge->options.seed,
                                                 .keep_resampled = judge->options.keep_resampled};
    return glint_metrics_compare(&verdict->result, &target->pixels, &options, &verdict->errors[target->kind], err);
}

/* Counts end reasons, with the errors of the rays' pixels against the truth, or against the reference if there is no truth. */
static bool count_rays(struct glint_judge *judge, const struct glint_pipeline *pipeline, const struct target *target,
                       struct glint_verdict *verdict, struct glint_error *err) {
    uint8_t *compared = target ? malloc(judge->pixels + 1) : NULL;
    if (target && !compared) return no_memory(err, "judge");
    for (size_t i = 0; compared && i < judge->pixels; i++)
        compared[i] = verdict->coverage[i] && judge->labels[i] != GLINT_CLASS_NONE &&
                      !(target->error && isinf(target->error[i])); /* the target is unknown there */
    bool ok = glint_study_ends(judge->replay, judge->options.effect, judge->labels, &verdict->result,
                               target ? &target->pixels : NULL, compared, &verdict->ends, err);
    const struct glint_ends *ends = &verdict->ends;
    const double rays = glint_pipeline_rays(pipeline), traced = (double)ends->rays * rays / (double)judge->pixels;
    verdict->steps_px =
        ends->steps * traced + (ends->more_steps[0] + ends->more_steps[1] * rays) / (double)judge->pixels;
    verdict->fetches_px =
        ends->fetches * traced + (ends->more_fetches[0] + ends->more_fetches[1] * rays) / (double)judge->pixels;
    free(compared);
    return ok;
}

/* If the capture has no truth, the verdict has no figures for that target. */
static bool get_targets(struct glint_judge *judge, const struct glint_pipeline *pipeline, struct glint_verdict *verdict,
                        const struct target *targets[GLINT_TARGET_COUNT], glint_progress progress, void *user,
                        struct glint_error *err) {
    if (judge->options.truth &&
        !(targets[GLINT_TARGET_TRUTH] =
              get_target(judge, GLINT_TARGET_TRUTH, pipeline, progress, user, &verdict->no_truth)) &&
        verdict->no_truth.code != GLINT_ERROR_FORMAT)
        return glint_fail(err, verdict->no_truth.code, "%s", verdict->no_truth.message);
    return !judge->options.reference || (targets[GLINT_TARGET_REFERENCE] = get_target(
                                             judge, GLINT_TARGET_REFERENCE, pipeline, progress, user, err)) != NULL;
}

bool glint_judge_evaluate(struct glint_judge *judge, const struct glint_pipeline *pipeline, uint32_t lineage,
                          struct glint_verdict *verdict, glint_progress progress, void *user, struct glint_error *err) {
    const struct glint_replay_options options = {.results = judge->options.effect->results,
                                                 .diagnostics = true,
                                                 .all = judge->options.all,
                                                 .skip = judge->skip,
                                                 .force = judge->force,
                                                 .keep_bytes = judge->options.keep_bytes,
                                                 .lineage = lineage};
    const struct target *targets[GLINT_TARGET_COUNT] = {NULL};
    *verdict = (struct glint_verdict){0};
    if (!judge->capture) return glint_fail(err, GLINT_ERROR_USAGE, "no capture is loaded");
    if (!glint_study_made(pipeline, judge->options.effect))
        return glint_fail(err, GLINT_ERROR_USAGE, "no slot of the pipeline makes the %s", judge->options.effect->noun);
    bool ok = get_targets(judge, pipeline, verdict, targets, progress, user, err);
    const double start = glint_now_seconds();
    ok = ok && glint_replay_run(judge->replay, pipeline, &options, progress, user, err) &&
         read_result(judge, verdict, err) && read_passes(judge, verdict, err);
    const double ran = glint_now_seconds();
    for (int k = 0; ok && k < GLINT_TARGET_COUNT; k++)
        ok = !targets[k] || compare_with_target(judge, targets[k], verdict, err);
    const struct target *best = targets[targets[GLINT_TARGET_TRUTH] ? GLINT_TARGET_TRUTH : GLINT_TARGET_REFERENCE];
    ok = ok && count_rays(judge, pipeline, best, verdict, err);
    verdict->run_seconds = ran - start;
    verdict->metric_seconds = glint_now_seconds() - ran;
    if (!ok) glint_verdict_finish(verdict);
    return ok;
}

void glint_judge_next_round(struct glint_judge *judge) {
    judge->round++;
    judge->measured_count = 0;
}

static const struct measured *find_measured(const struct glint_judge *judge, uint64_t key) {
    for (size_t i = 0; i < judge->measured_count; i++)
        if (judge->measured[i].key == key) return &judge->measured[i];
    return NULL;
}

static bool add_measured(struct glint_judge *judge, const struct glint_pass_result *result, struct glint_error *err) {
    struct measured *larger = realloc(judge->measured, (judge->measured_count + 1) * sizeof *larger);
    if (!larger) return no_memory(err, "judge");
    judge->measured = larger;
    judge->measured[judge->measured_count++] = (struct measured){result->key, result->time.median_ns};
    return true;
}

void glint_cost_finish(struct glint_cost *cost) {
    free(cost->passes);
    *cost = (struct glint_cost){0};
}

static bool add_cost(struct glint_judge *judge, const struct glint_pass_result *result, struct glint_cost *cost,
                     struct glint_error *err) {
    const struct measured *measured = result->cached ? find_measured(judge, result->key) : NULL;
    if (result->cached && !measured)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s was neither run nor measured in this round",
                          result->pass->slot, result->pass->variant);
    const uint64_t ns = measured ? measured->ns : result->time.median_ns;
    cost->passes[cost->pass_count++] = (struct glint_pass_cost){result->pass, result->cached_work, ns};
    *(result->cached_work ? &cost->cubemaps_ns : &cost->frame_ns) += ns;
    return !result->key || result->cached || add_measured(judge, result, err);
}

bool glint_judge_time(struct glint_judge *judge, const struct glint_pipeline *pipeline, uint32_t lineage, bool whole,
                      struct glint_cost *cost, glint_progress progress, void *user, struct glint_error *err) {
    const struct glint_replay_options options = {.results = judge->options.effect->results,
                                                 .all = judge->options.all,
                                                 .skip = judge->skip,
                                                 .force = judge->force,
                                                 .repeat = 1,
                                                 .warmup = 1,
                                                 .no_cache = whole,
                                                 .round = judge->round,
                                                 .keep_bytes = judge->options.keep_bytes,
                                                 .lineage = lineage};
    size_t count = 0;
    *cost = (struct glint_cost){0};
    if (!glint_replay_run(judge->replay, pipeline, &options, progress, user, err)) return false;
    const struct glint_pass_result *results = glint_replay_results(judge->replay, &count);
    bool ok = (cost->passes = calloc(count + 1, sizeof *cost->passes)) != NULL || no_memory(err, "judge");
    for (size_t i = 0; ok && i < count; i++) ok = !results[i].ran || add_cost(judge, &results[i], cost, err);
    if (!ok) glint_cost_finish(cost);
    return ok;
}
