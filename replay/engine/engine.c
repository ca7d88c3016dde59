/* Runs a plan: allocates images, decides what must execute, uploads, executes. */
#include "run.h"

#include <stdlib.h>

bool engine_init(struct engine *engine, struct glint_device *device, struct frame_source *source, struct pool *pool,
                 struct glint_error *err) {
    *engine = (struct engine){.device = device, .gpu = &device->gpu, .pool = pool, .source = source};
    return host_buffer_init(&engine->frame, engine->gpu, HOST_BUFFER_UNIFORM, sizeof(struct frame_block), "frame", err);
}

void engine_finish(struct engine *engine) {
    if (!engine->gpu) return;
    host_buffer_finish(&engine->frame, engine->gpu);
    host_buffer_finish(&engine->probes, engine->gpu);
    host_buffer_finish(&engine->values, engine->gpu);
    free(engine->probed);
}

static bool allocate_run(struct run *run, struct glint_error *err) {
    const size_t images = run->graph->image_count + 1, passes = run->graph->pass_count + 1;
    run->images = calloc(images, sizeof *run->images);
    run->keys = calloc(images, sizeof *run->keys);
    run->needed = calloc(images, sizeof *run->needed);
    run->stored = calloc(images, sizeof *run->stored);
    run->steps = calloc(passes, sizeof *run->steps);
    return (run->images && run->keys && run->needed && run->stored && run->steps) ||
           glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static bool put_aside(struct run *run, struct glint_error *err) {
    const size_t count = run->graph->image_count;
    bool *written = calloc(count + 1, sizeof *written);
    bool ok = written || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; ok && i < count; i++) written[i] = run_writes(run, i);
    ok = ok && pool_put_aside(run->pool, run->plan, run->images, run->keys, written, err);
    free(written);
    return ok;
}

static bool compute_frame(struct run *run, struct glint_error *err) {
    if (!allocate_run(run, err) || !probes_prepare(run, err) || !pool_allocate(run->pool, run->plan, run->images, err))
        return false;
    run->touched = true;
    if (!run_keys(run, err)) return false;
    pool_recall(run->pool, run->plan, run->images, run->keys);
    run_decide(run);
    if (!put_aside(run, err) || !run_upload(run, err)) return false;
    const double start = glint_now_seconds();
    const bool ok =
        run_prepare(run, err) && run_execute(run, err) && run_count_lists(run, err) && probes_finish(run, err);
    run->source->seconds[PHASE_PASSES] += glint_now_seconds() - start;
    return ok;
}

bool engine_run(struct run *run, struct engine *engine, const struct frame_plan *plan, glint_progress progress,
                void *user, struct glint_error *err) {
    *run = (struct run){.engine = engine,
                        .plan = plan,
                        .graph = &plan->graph,
                        .sizes = &plan->sizes,
                        .options = plan->options,
                        .source = engine->source,
                        .pool = engine->pool,
                        .gpu = engine->gpu,
                        .progress = progress,
                        .user = user};
    struct glint_error own = {0};
    if (compute_frame(run, &own)) return true;
    if (run->touched && own.code != GLINT_ERROR_INTERRUPTED)
        pool_drop(engine->pool, true); /* their contents are undefined now */
    return glint_fail(err, own.code, "%s", own.message);
}

void engine_release(struct run *run) {
    if (!run->engine) return;
    rays_release(run);
    GPU_DESTROY(run->gpu, vkDestroyQueryPool, run->queries);
    GPU_DESTROY(run->gpu, vkDestroyDescriptorPool, run->descriptors);
    for (size_t p = 0; run->steps && p < run->graph->pass_count; p++) {
        free(run->steps[p].ns);
        for (size_t d = 0; d < run->steps[p].dispatch_count; d++) free(run->steps[p].dispatches[d].layers);
        free(run->steps[p].dispatches);
    }
    for (size_t i = 0; run->stored && i < run->graph->image_count; i++) free(run->stored[i]);
    free(run->steps);
    free(run->images);
    free(run->keys);
    free(run->stored);
    free(run->needed);
    *run = (struct run){0};
}
