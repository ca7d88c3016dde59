/* Replays: the order of a run's steps, and access to its results. */
#include "bad_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "timing.h"

struct glint_replay *glint_replay_create(struct glint_device *device, struct glint_error *err) {
    struct glint_replay *replay = calloc(1, sizeof *replay);
    if (!replay) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    replay->device = device;
    if (!device) return replay;
    if (!programs_init(device, err) ||
        !host_buffer_init(&replay->frame, device, HOST_BUFFER_UNIFORM, sizeof(struct frame_block), "frame", err))
        glint_replay_destroy(&replay);
    return replay;
}

static void forget_results(struct glint_replay *replay) {
    free(replay->results);
    replay->results = NULL;
    free(replay->cache_keys);
    replay->cache_keys = NULL;
    free(replay->cache);
    replay->cache = NULL;
    replay->result_count = 0;
    free(replay->bad);
    replay->bad = NULL;
    replay->bad_count = replay->bad_captured = 0;
    json_decref(replay->record);
    replay->record = NULL;
    for (struct image *image = replay->images; image; image = image->next) image_hide(image);
}

void glint_replay_destroy(struct glint_replay **pointer) {
    struct glint_replay *replay = *pointer;
    *pointer = NULL;
    if (!replay) return;
    forget_results(replay);
    channels_finish(&replay->gbuffer);
    channels_finish(&replay->sky);
    if (replay->device) {
        replay_drop_images(replay, true);
        host_buffer_finish(&replay->frame, replay->device);
        host_buffer_finish(&replay->staging, replay->device);
        host_buffer_finish(&replay->probes, replay->device);
    }
    free(replay->plan);
    free(replay->probed);
    free(replay);
}

bool glint_replay_load(struct glint_replay *replay, struct glint_capture *capture, struct glint_error *err) {
    if (capture && !glint_capture_find(capture, "gbuffer"))
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing, and a replay needs it",
                          glint_capture_path(capture));
    if (capture) replay_age_images(replay, glint_capture_frame(capture));
    replay->capture = capture;
    replay->serial++;
    replay->surveyed = false;
    replay->survey = (struct glint_survey){0};
    if (capture) survey_capture_parts(capture, &replay->survey);
    replay->survey.has_history = capture && !glint_capture_frame(capture)->cut && replay_has_history(replay);
    replay->sky_hash = 0;
    replay->hash[0] = 0;
    channels_finish(&replay->gbuffer);
    channels_finish(&replay->sky);
    forget_results(replay);
    memset(replay->seconds, 0, sizeof replay->seconds);
    return true;
}

bool replay_hash(struct glint_replay *replay, char hash[33], struct glint_error *err) {
    const double start = now_seconds();
    if (!replay->hash[0] && !glint_capture_hash(replay->capture, replay->hash, err)) {
        replay->hash[0] = 0;
        return false;
    }
    memcpy(hash, replay->hash, sizeof replay->hash);
    replay->seconds[PHASE_READ] += now_seconds() - start;
    return true;
}

static bool allocate_run(struct run *run, struct glint_error *err) {
    size_t images = run->graph.image_count + 1, passes = run->graph.pass_count + 1;
    run->images = calloc(images, sizeof *run->images);
    run->keys = calloc(images, sizeof *run->keys);
    run->needed = calloc(images, sizeof *run->needed);
    run->given = calloc(images, sizeof *run->given);
    run->steps = calloc(passes, sizeof *run->steps);
    run->host_seconds = calloc(passes, sizeof *run->host_seconds);
    return (run->images && run->keys && run->needed && run->given && run->steps && run->host_seconds) ||
           glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static bool store_results(struct run *run, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    size_t count = run->graph.pass_count;
    replay->results = calloc(count + 1, sizeof *replay->results);
    replay->cache_keys = calloc(count + 1, sizeof *replay->cache_keys);
    replay->cache = run->content[0] ? strdup(run->options->cache) : NULL;
    struct whole_work *work = calloc(count + 1, sizeof *work);
    if (!replay->results || !replay->cache_keys || !work || (run->content[0] && !replay->cache)) {
        free(work);
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    }
    replay_whole_work(replay, run->pipeline, run->options, run->inputs, work);
    run_count_faces(run, &replay->faces);
    for (size_t p = 0; p < count; p++) {
        const struct graph_pass *pass = &run->graph.passes[p];
        struct glint_pass_result *result = &replay->results[p];
        *result = (struct glint_pass_result){.pass = pass->pass,
                                             .ran = pass->runs,
                                             .shown = pass->runs || pass->instead,
                                             .cached_work = pass->cached_work};
        memcpy(result->reason, pass->reason, sizeof result->reason);
        result->texels = work[p].texels;
        if (!pass->runs) continue;
        if (pass->pass->host) {
            uint64_t ns = (uint64_t)(run->host_seconds[p] * 1e9);
            result->time = time_statistics(&ns, 1);
        } else {
            result->cached = !run->steps[p].execute;
            result->key = run->steps[p].key;
            if (!run->options->outputs) /* a file of all its images */
                memcpy(replay->cache_keys[p], run->steps[p].cache_key, CACHE_KEY_SIZE);
            result->time = time_statistics(run->steps[p].ns, run->steps[p].timed);
        }
    }
    free(work);
    replay->result_count = count;
    replay->record = run_record(run);
    return replay->record ? bad_values_of_capture(run, err) : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

bool run_work(struct run *run, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    const struct glint_replay_options *options = run->options;
    if (options->inputs && !(run->inputs = glint_run_open(options->inputs, err))) return false;
    if (!replay_graph(replay, run->pipeline, options, run->inputs, &run->graph, err)) return false;
    double start;
    if (!allocate_run(run, err) || !tables_init(&run->tables, &run->graph, replay->capture, run->host_seconds, err) ||
        !run_sizes(run, err) || !probes_prepare(run, err) || !run_history(run, err))
        return false;
    frame_block_fill(&run->block, glint_capture_frame(replay->capture), &run->sizes);
    const struct glint_part_info *mirror = glint_capture_find(replay->capture, MIRROR_PART);
    run->block.flags.w = run->pipeline->first_ray;
    run->block.up.w = options->float_precision ? INFINITY : HALF_LARGEST;
    run->block.work = (uvec4){options->all, pipeline_shows_all(run->pipeline), 0, 0};
    float classes[2];
    pipeline_classes(run->pipeline, &classes[0], &classes[1]);
    memcpy(&run->block.work.z, classes, sizeof classes);
    if (mirror) frame_block_mirror(&run->block, glint_capture_frame(replay->capture), &mirror->planar);
    if (!run_allocate(run, err)) return false;
    if (options->cache && !replay_hash(replay, run->content, NULL)) run->content[0] = 0;
    run->touched = true;
    if (!run_keys(run, err)) return false;
    run_recall(run);
    run_decide(run);
    if (!run_put_aside(run, err) || !run_upload(run, err)) return false;
    start = now_seconds();
    bool ok = run_prepare(run, err) && run_execute(run, err) && run_count_tiles(run, err) && probes_finish(run, err);
    replay->seconds[PHASE_PASSES] += now_seconds() - start;
    return ok;
}

bool glint_replay_run(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                      const struct glint_replay_options *options, glint_progress progress, void *user,
                      struct glint_error *err) {
    static const struct glint_replay_options defaults;
    struct run run = {.replay = replay,
                      .pipeline = pipeline,
                      .options = options ? options : &defaults,
                      .progress = progress,
                      .user = user};
    forget_results(replay);
    replay->runs++;
    if (!replay->device) return glint_fail(err, GLINT_ERROR_USAGE, "a replay without a device can only plan");
    struct glint_error own = {0};
    bool ok = run_work(&run, &own) && store_results(&run, &own);
    channels_finish(&replay->gbuffer);
    channels_finish(&replay->sky);
    if (!ok) forget_results(replay);
    run_release(&run);
    replay->ran = ok;
    if (ok) replay_drop_images(replay, false);
    else if (run.touched && own.code != GLINT_ERROR_INTERRUPTED)
        replay_drop_images(replay, true); /* what the device did to them is not known */
    return ok || glint_fail(err, own.code, "%s", own.message);
}

const struct glint_pass_result *glint_replay_results(const struct glint_replay *replay, size_t *count) {
    *count = replay->result_count;
    return replay->results;
}

size_t glint_replay_image_count(const struct glint_replay *replay) {
    size_t count = 0;
    for (const struct image *image = replay->images; image; image = image->next)
        for (uint32_t i = 0; image_shown(image, i); i++) count++;
    return count;
}

const struct glint_image *glint_replay_image(const struct glint_replay *replay, size_t i) {
    const struct glint_image *shown;
    for (const struct image *image = replay->images; image; image = image->next)
        for (uint32_t l = 0; (shown = image_shown(image, l)); l++)
            if (i-- == 0) return shown;
    return NULL;
}

const struct glint_image *glint_replay_find_image(const struct glint_replay *replay, const char *name) {
    const struct glint_image *shown;
    for (const struct image *image = replay->images; image; image = image->next)
        for (uint32_t l = 0; (shown = image_shown(image, l)); l++)
            if (strcmp(shown->name, name) == 0) return shown;
    return NULL;
}

double glint_replay_seconds(const struct glint_replay *replay, const char *phase) {
    static const char *const names[PHASES] = {"read", "upload", "passes", "readback", "write"};
    for (size_t i = 0; i < PHASES; i++)
        if (strcmp(names[i], phase) == 0) return replay->seconds[i];
    return 0;
}
