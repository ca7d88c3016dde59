/* --against: compares a run with the truth in the capture, the preset `reference`, or both. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "replay/against.h"
#include "options/args.h"

void against_parse(struct against *against, char *text, struct argp_state *state) {
    static const char *const answers[] = {"truth", "reference", "both", NULL};
    char *run = strchr(text, '=');
    if (run) *run++ = '\0';
    int which = arg_choice("against", text, answers, state);
    against->truth = which != 1;
    against->reference = which != 0;
    against->run = run;
    if (run && !against->reference) argp_error(state, "--against=truth takes no run: the truth is in the capture");
    if (run && !*run) argp_error(state, "--against=%s=RUN: the name of the run is empty", text);
}

static bool is_without_fog(const struct glint_run *run) {
    json_t *json = json_loads(glint_run_json(run), 0, NULL), *pass;
    bool without = false;
    size_t i;
    json_array_foreach(json_object_get(json, "passes"), i, pass) without |=
        json_is_false(json_object_get(json_object_get(pass, "parameters"), "fog"));
    json_decref(json);
    return without;
}

bool against_prepare(const struct against *against, bool *without_fog, struct glint_error *err) {
    struct glint_run *run = against->run ? glint_run_open(against->run, err) : NULL;
    *without_fog = against->truth || (run && is_without_fog(run));
    const bool ok = run || !against->run;
    glint_run_close(&run);
    return ok;
}

bool against_begin(struct against *against, struct glint_device *device, const struct glint_pipeline *pipeline,
                   const struct list *captures, struct glint_error *err) {
    const bool traced = against->reference && !against->run;
    const struct effect_search search = {against->name, &pipeline, 1, traced, against->truth ? captures : NULL};
    against->device = device;
    if (!against->truth && !against->reference) return true;
    if (!(against->effect_count = effects_find(&search, against->effects, err))) return false;
    if (!against->reference) return true;
    if (!(against->pipeline = glint_study_reference(pipeline, err))) return false;
    struct glint_run *run = against->run ? glint_run_open(against->run, err) : NULL;
    bool ok = !against->run || run;
    for (size_t e = 0; run && ok && e < against->effect_count; e++)
        ok = glint_study_fits(run, against->run, pipeline, against->effects[e], err);
    glint_run_close(&run);
    return ok;
}

void against_finish(struct against *against) {
    glint_replay_destroy(&against->replay);
    glint_pipeline_destroy(&against->pipeline);
}

static bool load_reference(struct against *against, struct glint_capture *capture, struct glint_error *err) {
    if (!against->replay && !(against->replay = glint_replay_create(against->device, err))) return false;
    return glint_replay_load(against->replay, capture, err);
}

/* A reference image, and the standard error of its samples, if it is a mean of samples. */
struct answer {
    struct glint_pixels pixels;
    float *error;
};
static void answer_finish(struct answer *answer) {
    glint_pixels_finish(&answer->pixels);
    free(answer->error);
}

static bool is_of_another(const struct glint_run *run, struct glint_capture *capture) {
    char hash[33];
    json_t *json = json_loads(glint_run_json(run), 0, NULL);
    const char *theirs = json_string_value(json_object_get(json_object_get(json, "capture"), "xxh3_128"));
    const bool other = !theirs || (glint_capture_hash(capture, hash, NULL) && strcmp(theirs, hash) != 0);
    json_decref(json);
    return other;
}

static bool run_answer(const char *folder, struct glint_capture *capture, const struct glint_effect *effect,
                       struct answer *answer, bool *other, struct glint_error *err) {
    struct glint_run *run = glint_run_open(folder, err);
    *other = run && is_of_another(run, capture);
    bool ok = run && glint_study_run_result(run, effect, &answer->pixels, err) &&
              glint_study_run_error(run, effect, &answer->error, err);
    glint_run_close(&run);
    return ok;
}

const char *const *against_results(const struct against *against, const char *names[]) {
    size_t count = 0;
    for (size_t e = 0; e < against->effect_count; e++)
        for (size_t k = 0; against->effects[e]->results[k]; k++) names[count++] = against->effects[e]->results[k];
    names[count] = NULL;
    return names;
}

/* The reference's result of this capture. */
static bool reference_answer(struct against *against, struct glint_capture *capture, const struct glint_effect *effect,
                             struct answer *answer, bool *other, struct glint_error *err) {
    const struct glint_reference_options options = {.effect = effect, .all = against->all};
    if (against->run) return run_answer(against->run, capture, effect, answer, other, err);
    struct glint_reference *reference =
        load_reference(against, capture, err)
            ? glint_reference_create(against->replay, capture, against->pipeline, &options, err)
            : NULL;
    bool ok = reference &&
              glint_reference_trace(reference, glint_pipeline_rays(against->pipeline), 0, against->progress,
                                    against->user, err) &&
              glint_reference_pixels(reference, &answer->pixels, &answer->error, err);
    glint_reference_destroy(&reference);
    return glint_replay_load(against->replay, NULL, ok ? err : NULL) && ok;
}

/* Where the light of the first class is from, here and in the reference, of which one ray is enough for that: those of other classes are
   drawn at random, and no two are the same. */
static bool cross_sources(struct against *against, struct glint_capture *capture, const uint8_t *labels,
                          struct comparison *c, struct glint_error *err) {
    const struct glint_part_info *gbuffer = glint_capture_find(capture, "gbuffer");
    const struct glint_replay_options options = {
        .results = c->effect->results, .all = against->all, .diagnostics = true};
    const size_t pixels = (size_t)gbuffer->width * gbuffer->height;
    if (!c->found_source.labels) return true;
    struct glint_pipeline *reference = glint_study_reference(against->pipeline, err);
    bool ok =
        reference && glint_pipeline_set(reference, "pipeline.rays=1", err) && load_reference(against, capture, err) &&
        glint_replay_run(against->replay, reference, &options, against->progress, against->user, err) &&
        glint_study_source(against->replay, c->effect, gbuffer->width, gbuffer->height, &c->reference_source, err) &&
        glint_replay_load(against->replay, NULL, err);
    if (reference) glint_pipeline_destroy(&reference);
    if (!ok || !c->reference_source.labels) return ok;
    uint8_t *mask = malloc(pixels);
    c->sources = malloc((c->found_source.count + 1) * (c->reference_source.count + 1) * sizeof *c->sources);
    ok = (mask && c->sources) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; ok && i < pixels; i++) mask[i] = labels[i] == GLINT_CLASS_FIRST;
    if (ok) glint_classes_cross(&c->found_source, &c->reference_source, pixels, mask, c->sources);
    free(mask);
    return ok;
}

/* All known classes of pixels. */
struct sets {
    struct glint_classes of[GLINT_CAPTURE_CLASSES + 1];
    size_t own, count; /* own: number of classes that this owns */
};

static bool keep_error(const struct glint_pixels *found, const struct glint_pixels *answer, const uint8_t *mask,
                       struct glint_pixels *error, struct glint_error *err) {
    const size_t pixels = (size_t)found->width * found->height;
    const uint32_t channels = found->components < 3 || answer->components < 3 ? 1 : 3;
    *error = (struct glint_pixels){found->width, found->height, 1, calloc(pixels + 1, sizeof(float))};
    if (!error->values) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < pixels; i++)
        for (uint32_t k = 0; k < channels && (!mask || mask[i]); k++)
            error->values[i] +=
                fabsf(found->values[i * found->components + k] - answer->values[i * answer->components + k]) /
                (float)channels;
    return true;
}

static bool compare(const struct against *against, struct glint_capture *capture, const struct glint_effect *effect,
                    const struct sets *sets, const struct glint_pixels *found, const struct answer *answer,
                    struct glint_metric_table *table, struct glint_pixels *error, struct glint_error *err) {
    const double exposure = glint_capture_frame(capture)->exposure;
    struct glint_metric_options options = against->metrics;
    metric_args_default(&options);
    glint_effect_channels(effect, &options.found_channels);
    options.truth_channels = options.found_channels;
    options.mask = sets->of[GLINT_CLASSES_EFFECT].labels;
    options.classes = sets->of;
    options.class_sets = sets->count;
    options.truth_error = answer->error;
    options.exposure = exposure > 0 ? log2(exposure) : 0;
    return glint_metrics_compare(found, &answer->pixels, &options, table, err) &&
           keep_error(found, &answer->pixels, options.mask, error, err);
}

static bool compare_images(struct against *against, struct glint_replay *replay, struct glint_capture *capture,
                           const struct glint_pipeline *pipeline, struct comparison *c, struct glint_error *err) {
    struct glint_pixels found = {0};
    struct answer truth = {0}, reference = {0};
    struct sets sets = {0};
    const struct glint_effect *effect = c->effect;
    bool ok = glint_study_result(replay, effect, &found, err) &&
              glint_study_source(replay, effect, found.width, found.height, &c->found_source, err) &&
              glint_study_classes(capture, effect, sets.of, &sets.own, err);
    sets.count = sets.own;
    if (c->found_source.labels) sets.of[sets.count++] = c->found_source;
    const uint8_t *labels = sets.of[GLINT_CLASSES_EFFECT].labels;
    if (ok && c->truth)
        ok = glint_study_truth(capture, effect, pipeline, &truth.pixels, &truth.error, err) &&
             compare(against, capture, effect, &sets, &found, &truth, &c->to_truth, &c->truth_error, err);
    if (ok && c->reference)
        ok = reference_answer(against, capture, effect, &reference, &c->other_capture, err) &&
             compare(against, capture, effect, &sets, &found, &reference, &c->to_reference, &c->reference_error, err) &&
             cross_sources(against, capture, labels, c, err);
    if (ok && c->truth && c->reference)
        ok = glint_study_reference_bias(&reference.pixels, reference.error, &truth.pixels, truth.error, labels,
                                        &c->missing, err);
    for (size_t k = 0; k < sets.own; k++) glint_classes_finish(&sets.of[k]);
    answer_finish(&truth);
    answer_finish(&reference);
    glint_pixels_finish(&found);
    return ok;
}

void comparison_finish(struct comparison *c) {
    glint_metric_table_finish(&c->to_truth);
    glint_metric_table_finish(&c->to_reference);
    glint_pixels_finish(&c->truth_error);
    glint_pixels_finish(&c->reference_error);
    glint_classes_finish(&c->found_source);
    glint_classes_finish(&c->reference_source);
    free(c->sources);
    *c = (struct comparison){0};
}

bool against_valid(const struct comparison *c, const char *capture, struct glint_error *err) {
    char what[600];
    snprintf(what, sizeof what, "%.500s: the %.60s against the truth", capture, c->effect->noun);
    if (!glint_metrics_valid(&c->to_truth, what, err)) return false;
    snprintf(what, sizeof what, "%.500s: the %.60s against the reference", capture, c->effect->noun);
    return glint_metrics_valid(&c->to_reference, what, err);
}

static bool draws_normals(const struct glint_pipeline *pipeline) {
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        for (size_t r = 0; r < pass->row_count; r++)
            if (pass->rows[r].kind == GLINT_ROW_SPEC && !strcmp(pass->rows[r].name, "jitter"))
                return glint_pipeline_value(pipeline, pass, &pass->rows[r]) != 0;
    }
    return false;
}

bool against_compare(struct against *against, size_t number, struct glint_replay *replay, struct glint_capture *capture,
                     const struct glint_pipeline *pipeline, struct comparison *c, struct glint_error *err) {
    const struct glint_effect *effect = against->effects[number];
    const struct glint_row *made = glint_study_made(pipeline, effect);
    struct glint_error image = {0};
    *c = (struct comparison){.effect = effect,
                             .unit = made ? made->unit : "1",
                             .several = against->effect_count > 1,
                             .truth = against->truth,
                             .reference = against->reference,
                             .jittered = draws_normals(pipeline)};
    c->has_rays = against->truth && effect->rays;
    if (c->has_rays && !glint_study_trace(replay, capture, effect, effect->classes[0].most, &c->rays, err))
        return false;
    c->has_image = compare_images(against, replay, capture, pipeline, c, &image);
    if (c->has_image) return true;
    /* Rays can be compared without the image of the result, such as with --passes screen_trace. */
    if (against->reference || !c->has_rays || (image.code != GLINT_ERROR_USAGE && image.code != GLINT_ERROR_FORMAT)) {
        if (err) *err = image;
        return false;
    }
    snprintf(c->no_image, sizeof c->no_image, "%s", image.message);
    return true;
}
