/* Memory of the loaded frame and of a plan. */
#include "frame_plan.h"

#include <stdlib.h>
#include <string.h>

bool frame_source_hash(struct frame_source *source, char hash[33], struct glint_error *err) {
    const double start = glint_now_seconds();
    if (!source->hash[0] && !glint_capture_hash(source->capture, source->hash, err)) {
        source->hash[0] = 0;
        return false;
    }
    memcpy(hash, source->hash, sizeof source->hash);
    source->seconds[PHASE_READ] += glint_now_seconds() - start;
    return true;
}

static int by_number(const void *a, const void *b) {
    const struct glint_part_info *const *left = a, *const *right = b;
    return ((*left)->index > (*right)->index) - ((*left)->index < (*right)->index);
}

bool frame_source_load(struct frame_source *source, struct glint_capture *capture, struct glint_error *err) {
    const size_t parts = capture ? glint_capture_part_count(capture) : 0;
    frame_source_finish(source);
    *source = (struct frame_source){.capture = capture, .serial = source->serial + 1};
    if (!(source->cubemaps = calloc(parts + 1, sizeof *source->cubemaps)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < parts; i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (part->has_cubemap && !part->previous) source->cubemaps[source->cubemap_count++] = part;
    }
    qsort(source->cubemaps, source->cubemap_count, sizeof *source->cubemaps, by_number);
    return true;
}

void frame_source_finish(struct frame_source *source) {
    frame_source_release(source);
    free(source->cubemaps);
    source->cubemaps = NULL;
}

void frame_source_release(struct frame_source *source) {
    channels_finish(&source->gbuffer);
    channels_finish(&source->sky);
}

void frame_plan_finish(struct frame_plan *plan) {
    free(plan->active);
    free(plan->reach.captured);
    free(plan->reach.limited);
    free(plan->whole);
    tables_finish(&plan->own_tables);
    graph_finish(&plan->graph);
    glint_run_close(&plan->inputs);
    glint_run_close(&plan->history);
    *plan = (struct frame_plan){0};
}
