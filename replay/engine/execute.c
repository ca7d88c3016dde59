/* Executes rounds of all passes and measures them. */
#include "run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void write_stamp(struct run *run) {
    if (run->queries)
        vkCmdWriteTimestamp2(run->gpu->commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, run->queries, run->stamps++);
}

/* There is a timestamp before the first pass and one after each pass. The time of a pass is the difference to the timestamp before. */
static bool begin_commands(struct run *run, struct glint_error *err) {
    struct gpu *gpu = run->gpu;
    if (!device_begin(gpu, err)) return false;
    if (run->queries) vkCmdResetQueryPool(gpu->commands, run->queries, 0, (uint32_t)run->graph->pass_count + 1);
    run->stamps = run->recorded = 0;
    write_stamp(run);
    return true;
}

static void record_step(struct run *run, struct step *step) {
    struct gpu *gpu = run->gpu;
    const struct glint_pass *pass = step->pass->pass;
    char label[128];
    snprintf(label, sizeof label, "%s/%s", pass->slot, pass->variant);
    device_begin_label(gpu, label);
    step_record(run, step);
    step->stamp = run->stamps;
    run->recorded++;
    write_stamp(run);
    device_end_label(gpu);
}

static bool read_times(struct run *run, struct glint_error *err) {
    struct gpu *gpu = run->gpu;
    for (size_t p = 0; run->queries && p < run->graph->pass_count; p++) {
        struct step *step = &run->steps[p];
        uint64_t ticks[2];
        if (!step->stamp) continue;
        VkResult result = vkGetQueryPoolResults(gpu->device, run->queries, step->stamp - 1, 2, sizeof ticks, ticks,
                                                sizeof ticks[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        char what[160];
        snprintf(what, sizeof what, "reading the time of %s/%s", step->pass->pass->slot, step->pass->pass->variant);
        if (!gpu_ok(gpu, result, what, err)) return false;
        const uint64_t passed = (ticks[1] - ticks[0]) & gpu->timestamp_mask;
        step->round_ns += (uint64_t)((double)passed * gpu->timestamp_ns);
        step->stamp = 0;
    }
    return true;
}

static bool submit_commands(struct run *run, const char *what, struct glint_error *err) {
    return device_submit(run->gpu, what, run->recorded, err) && read_times(run, err);
}

/* What is running, for messages: the passes in the current command buffer, by the first and the last of them. */
static bool submit_passes(struct run *run, const struct glint_pass *first, const struct glint_pass *last,
                          struct glint_error *err) {
    char what[256];
    if (first == last) snprintf(what, sizeof what, "running %s/%s", first->slot, first->variant);
    else snprintf(what, sizeof what, "running the passes from %s to %s", first->slot, last->slot);
    return submit_commands(run, what, err);
}

/* Executes passes first … end - 1 for one ray. With `apart` each is submitted on its own, so that the progress callback can stop the run
   between two passes. Otherwise they are submitted together, which timing requires since a device that has been idle runs the first pass
   slowly. `done` and `share` are the fractions of the run's progress before these passes and for them. */
static bool execute_passes(struct run *run, size_t first, size_t end, uint32_t ray, bool apart, double done,
                           double share, struct glint_error *err) {
    struct frame_block block = run->plan->block;
    const struct glint_pass *from = NULL, *to = NULL; /* in the command buffer, unless `from` is NULL */
    block.flags.w += ray;
    memcpy(run->engine->frame.map, &block, sizeof block);
    for (size_t p = first; p < end; p++) {
        struct step *step = &run->steps[p];
        if (!step->execute) continue;
        const double here = done + share * (double)(p - first) / (double)(end - first);
        const struct glint_pass *pass = step->pass->pass;
        if (!glint_report_progress(run->progress, run->user, pass->slot, 0.2 + 0.8 * here, err)) {
            struct glint_error ignored = {0}; /* images are as the recorded commands leave them */
            if (from) submit_passes(run, from, to, &ignored);
            return false;
        }
        if (!from && !begin_commands(run, err)) return false;
        record_step(run, step);
        to = pass;
        if (!from) from = pass;
        if (!apart) continue;
        if (!submit_passes(run, from, to, err)) return false;
        from = NULL;
    }
    if (run->rays && first == run->graph->loop_first && end == run->graph->loop_end) {
        if (!from && !begin_commands(run, err)) return false;
        rays_record(run, ray);
        if (!from) return submit_commands(run, "adding up the rays", err);
    }
    return !from || submit_passes(run, from, to, err);
}

/* Executes all passes, those of the loop once for each ray, with a submission for each ray. */
static bool execute_round(struct run *run, bool apart, double done, double share, struct glint_error *err) {
    const struct graph *graph = run->graph;
    const size_t first = graph->loop_first, end = graph->loop_end;
    const uint32_t rays = glint_pipeline_rays(run->plan->pipeline);
    const double each = graph->pass_count ? share / (double)graph->pass_count : 0;
    if (!execute_passes(run, 0, first, 0, apart, done, each * (double)first, err)) return false;
    const double loop = each * (double)(end - first) / rays;
    for (uint32_t ray = 0; end > first && ray < rays; ray++)
        if (!execute_passes(run, first, end, ray, apart, done + each * (double)first + loop * ray, loop, err))
            return false;
    return execute_passes(run, end, graph->pass_count, 0, apart, done + each * (double)end,
                          each * (double)(graph->pass_count - end), err);
}

static bool reads_quick(const struct run *run, const struct glint_pass *pass) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (row_is_sampled(&pass->rows[r]) &&
            run->images[graph_bound(run->graph, &pass->rows[r]) - run->graph->images]->quick)
            return true;
    return false;
}

/* Notes what the images of a pass hold from now on. */
static void note_made(struct run *run, size_t p) {
    struct step *step = &run->steps[p];
    step->from_quick = step->quick || reads_quick(run, step->pass->pass);
    for (size_t i = 0; i < run->graph->image_count; i++) {
        const struct graph_image *image = &run->graph->images[i];
        if (image->source != SOURCE_MADE || image->maker != p) continue;
        run->images[i]->quick = step->from_quick;
        if (run->images[i]->transient) continue;
        run->images[i]->key = run->keys[i];
        run->images[i]->round = run->options->round;
    }
}

bool run_execute(struct run *run, struct glint_error *err) {
    const struct glint_replay_options *options = run->options;
    const uint32_t warmup = options->repeat == 0 ? 0 : options->warmup ? options->warmup : 1;
    const uint32_t rounds = warmup + (options->repeat ? options->repeat : 1);
    for (size_t p = 0; p < run->graph->pass_count; p++) {
        struct step *step = &run->steps[p];
        if (!step->execute) continue;
        if (!(step->ns = calloc(rounds, sizeof *step->ns))) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        for (size_t i = 0; i < run->graph->image_count; i++) /* undefined until the new contents are complete */
            if (run->graph->images[i].source == SOURCE_MADE && run->graph->images[i].maker == p)
                run->images[i]->key = 0, run->images[i]->quick = false;
    }
    for (uint32_t round = 0; round < rounds; round++) {
        for (size_t p = 0; p < run->graph->pass_count; p++) run->steps[p].round_ns = 0;
        const bool apart = run->progress && (round < warmup || rounds == 1);
        if (!execute_round(run, apart, (double)round / rounds, 1.0 / rounds, err)) return false;
        for (size_t p = 0; p < run->graph->pass_count && round >= warmup && run->queries; p++)
            if (run->steps[p].execute) run->steps[p].ns[run->steps[p].timed++] = run->steps[p].round_ns;
    }
    for (size_t p = 0; p < run->graph->pass_count; p++)
        if (run->steps[p].execute) note_made(run, p);
    return true;
}
