/* What the loaded frame and a plan own. */
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

void frame_source_load(struct frame_source *source, struct glint_capture *capture) {
    frame_source_release(source);
    *source = (struct frame_source){.capture = capture, .serial = source->serial + 1};
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
