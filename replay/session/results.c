/* Stores the results of a run for callers. */
#include "session.h"

#include <stdlib.h>
#include <string.h>

void results_forget(struct glint_replay *replay) {
    struct results *results = &replay->results;
    free(results->passes);
    free(results->cache_keys);
    free(results->cache);
    free(results->bad);
    json_decref(results->record);
    *results = (struct results){.faces = results->faces};
    for (struct pooled *image = replay->pool.images; image; image = image->next) pooled_hide(image);
}

/* Whether images of the pass that were up to date come from generic programs. */
static bool makes_quick(const struct run *run, size_t p) {
    for (size_t i = 0; i < run->graph->image_count; i++)
        if (run->graph->images[i].source == SOURCE_MADE && run->graph->images[i].maker == p && run->images[i]->quick)
            return true;
    return false;
}

static void store_pass(const struct run *run, size_t p, struct results *results) {
    const struct graph_pass *pass = &run->graph->passes[p];
    const struct step *step = &run->steps[p];
    struct glint_pass_result *result = &results->passes[p];
    *result = (struct glint_pass_result){.pass = pass->pass,
                                         .ran = pass->runs,
                                         .shown = pass->runs || pass->aliased,
                                         .cached_work = pass->cached_work,
                                         .texels = run->plan->whole[p].texels};
    memcpy(result->reason, pass->reason, sizeof result->reason);
    if (!pass->runs) return;
    if (pass->pass->host) {
        uint64_t ns = (uint64_t)(tables_seconds(run->plan->tables, pass->pass) * 1e9);
        result->time = glint_time_statistics(&ns, 1);
        result->time.cold = !run->options->repeat;
        return;
    }
    result->cached = !step->execute;
    result->quick = step->quick;
    result->from_quick = step->execute ? step->from_quick : makes_quick(run, p);
    result->key = step->key;
    if (!run->options->outputs) /* only a file with all images of the pass is cached */
        memcpy(results->cache_keys[p], step->cache_key, GLINT_CACHE_KEY_SIZE);
    result->time = glint_time_statistics(step->ns, step->timed);
    result->time.cold = result->time.n && !run->options->repeat;
}

bool results_store(struct glint_replay *replay, const struct run *run, struct glint_error *err) {
    const struct frame_plan *plan = run->plan;
    struct results *results = &replay->results;
    const size_t count = plan->graph.pass_count;
    results->passes = calloc(count + 1, sizeof *results->passes);
    results->cache_keys = calloc(count + 1, sizeof *results->cache_keys);
    results->cache = plan->content[0] ? strdup(plan->options->cache) : NULL;
    if (!results->passes || !results->cache_keys || (plan->content[0] && !results->cache))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    results->faces = plan->faces;
    for (size_t p = 0; p < count; p++) store_pass(run, p, results);
    results->count = count;
    results->record = run_record(replay, run);
    return results->record ? bad_values_of_capture(replay, run, err)
                           : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}
