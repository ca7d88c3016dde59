/* The public functions of a replay: load, survey, plan, run, and access to results. */
#include "session.h"

#include <stdlib.h>
#include <string.h>

#include "record.h"

bool session_fail(const struct glint_replay *replay, const struct glint_error *own, struct glint_error *err) {
    const bool device = own->code == GLINT_ERROR_DEVICE || own->code == GLINT_ERROR_MEMORY;
    const char *path = replay->source.capture && device ? glint_capture_path(replay->source.capture) : NULL;
    if (path && !strstr(own->message, path)) return glint_fail(err, own->code, "%s: %s", path, own->message);
    return glint_fail(err, own->code, "%s", own->message);
}

struct glint_replay *glint_replay_create(struct glint_device *device, struct glint_error *err) {
    struct glint_replay *replay = calloc(1, sizeof *replay);
    if (!replay) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    replay->device = device;
    replay->pool = (struct pool){.gpu = device ? &device->gpu : NULL, .source = &replay->source};
    replay->planner =
        (struct planner){.source = &replay->source, .pool = &replay->pool, .engine = device ? &replay->engine : NULL};
    if (device && !engine_init(&replay->engine, device, &replay->source, &replay->pool, err))
        glint_replay_destroy(&replay);
    return replay;
}

void glint_replay_destroy(struct glint_replay **pointer) {
    struct glint_replay *replay = *pointer;
    *pointer = NULL;
    if (!replay) return;
    results_forget(replay);
    frame_source_finish(&replay->source);
    pool_finish(&replay->pool);
    engine_finish(&replay->engine);
    free(replay->plan);
    free(replay);
}

struct glint_device *glint_replay_device(const struct glint_replay *replay) {
    return replay->device;
}

bool glint_replay_load(struct glint_replay *replay, struct glint_capture *capture, struct glint_error *err) {
    if (capture && !glint_capture_find(capture, GLINT_PART_GBUFFER))
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing, and a replay needs it",
                          glint_capture_path(capture));
    if (capture) pool_age(&replay->pool, glint_capture_frame(capture));
    if (!frame_source_load(&replay->source, capture, err)) return false;
    planner_load(&replay->planner);
    results_forget(replay);
    return true;
}

bool glint_replay_survey(struct glint_replay *replay, const struct glint_survey **found, struct glint_time *time,
                         struct glint_error *err) {
    static const struct glint_pipeline nothing;
    static const struct glint_replay_options defaults;
    struct glint_error own = {0};
    if (!replay->source.capture) return glint_fail(err, GLINT_ERROR_USAGE, "no capture is loaded");
    const bool ok = planner_survey(&replay->planner, &nothing, &defaults, true, &own);
    channels_finish(&replay->source.gbuffer);
    *found = &replay->planner.survey.figures;
    if (time) *time = replay->planner.survey.time;
    return ok || session_fail(replay, &own, err);
}

char *glint_replay_survey_json(struct glint_replay *replay, struct glint_error *err) {
    const struct glint_survey *survey;
    if (!glint_replay_survey(replay, &survey, NULL, err)) return NULL;
    json_t *json = survey_record(&replay->planner.survey, glint_capture_frame(replay->source.capture));
    char *text = record_text(json, JSON_INDENT(2));
    json_decref(json);
    if (!text) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    return text;
}

struct glint_survey_times glint_replay_survey_times(const struct glint_replay *replay) {
    const struct survey_state *survey = &replay->planner.survey;
    return (struct glint_survey_times){survey->time.median_ns +
                                           (survey->figures.active_traced ? survey->trace_time.median_ns : 0),
                                       survey->figures.active_surveyed ? survey->cubes.time.median_ns : 0};
}

bool glint_replay_plan(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                       const struct glint_replay_options *options, const struct glint_plan_entry **entries,
                       size_t *count, struct glint_error *err) {
    static const struct glint_replay_options defaults;
    struct frame_plan plan;
    struct glint_error own = {0};
    bool ok = plan_frame(&plan, &replay->planner, pipeline, options ? options : &defaults, false, &own);
    if (ok) {
        free(replay->plan);
        replay->plan = calloc(plan.graph.pass_count + 1, sizeof *replay->plan);
        ok = replay->plan || glint_fail(&own, GLINT_ERROR_MEMORY, "out of memory");
        replay->results.faces = plan.faces;
        replay->missing_count = plan_missing(&plan, replay->missing);
    }
    for (size_t i = 0; ok && i < plan.graph.pass_count; i++) {
        replay->plan[i] = (struct glint_plan_entry){.pass = plan.graph.passes[i].pass,
                                                    .runs = plan.graph.passes[i].runs,
                                                    .cached_work = plan.whole[i].cached_work,
                                                    .texels = plan.whole[i].texels};
        memcpy(replay->plan[i].reason, plan.graph.passes[i].reason, sizeof replay->plan[i].reason);
    }
    if (ok) *entries = replay->plan, *count = plan.graph.pass_count;
    channels_finish(&replay->source.gbuffer);
    frame_plan_finish(&plan);
    return ok || session_fail(replay, &own, err);
}

const struct glint_absence *glint_replay_missing(const struct glint_replay *replay, size_t i) {
    return i < replay->missing_count ? replay->missing[i] : NULL;
}

const char *glint_replay_warning(const struct glint_replay *replay, size_t i) {
    return json_string_value(json_array_get(json_object_get(replay->results.record, "warnings"), i));
}

bool glint_replay_run(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                      const struct glint_replay_options *options, glint_progress progress, void *user,
                      struct glint_error *err) {
    static const struct glint_replay_options defaults;
    struct frame_plan plan;
    struct run run = {0};
    struct glint_error own = {0};
    results_forget(replay);
    replay->pool.runs++;
    if (!replay->device) return glint_fail(err, GLINT_ERROR_USAGE, "a replay without a device can only plan");
    if (!options) options = &defaults;
    bool ok = plan_frame(&plan, &replay->planner, pipeline, options, true, &own);
    replay->missing_count = ok ? plan_missing(&plan, replay->missing) : 0;
    ok = ok && engine_run(&run, &replay->engine, &plan, progress, user, &own) && results_store(replay, &run, &own);
    frame_source_release(&replay->source);
    if (!ok) results_forget(replay);
    engine_release(&run);
    frame_plan_finish(&plan);
    pool_end_run(&replay->pool, options->lineage, ok);
    return ok || session_fail(replay, &own, err);
}

const struct glint_pass_result *glint_replay_results(const struct glint_replay *replay, size_t *count) {
    *count = replay->results.count;
    return replay->results.passes;
}

const struct glint_cube_faces *glint_replay_cube_faces(const struct glint_replay *replay) {
    return &replay->results.faces;
}

size_t glint_replay_image_count(const struct glint_replay *replay) {
    size_t count = 0;
    for (const struct pooled *image = replay->pool.images; image; image = image->next)
        for (uint32_t i = 0; pooled_shown(image, i); i++) count++;
    return count;
}

const struct glint_image *glint_replay_image(const struct glint_replay *replay, size_t i) {
    return pool_shown(&replay->pool, i);
}

const struct glint_image *glint_replay_find_image(const struct glint_replay *replay, const char *name) {
    return pool_find(&replay->pool, name);
}

bool glint_replay_read_image(struct glint_replay *replay, const struct glint_image *image, enum glint_type type,
                             void *out, struct glint_error *err) {
    struct glint_error own = {0};
    return pool_read_image(&replay->pool, image, type, out, &own) || session_fail(replay, &own, err);
}

bool glint_replay_probe(const struct glint_replay *replay, size_t i, struct glint_probe_trace *trace,
                        struct glint_error *err) {
    return engine_probe(&replay->engine, replay->results.passes, replay->results.count, i, trace, err);
}

bool glint_replay_shader_hash(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                              const struct glint_pass *pass, uint64_t *hash, struct glint_error *err) {
    const struct pipeline_pass *entry = pipeline_find(pipeline, pass->slot);
    struct spirv spirv;
    if (!replay->device) return glint_fail(err, GLINT_ERROR_USAGE, "a replay without a device compiles no shader");
    if (!spirv_find(&spirv, &replay->device->shaders, entry, err)) return false;
    *hash = spirv.hash;
    return true;
}

bool glint_replay_capture_hash(struct glint_replay *replay, char hash[33], struct glint_error *err) {
    return frame_source_hash(&replay->source, hash, err);
}

double glint_replay_seconds(const struct glint_replay *replay, const char *phase) {
    static const char *const names[PHASES] = {"read", "upload", "passes", "readback", "write"};
    for (size_t i = 0; i < PHASES; i++)
        if (strcmp(names[i], phase) == 0) return replay->source.seconds[i];
    return 0;
}
