/* The options of sweep, blame and tune that choose the effect, and the reference or truth for its errors. */
#include "options/answer_args.h"

#include <stdlib.h>
#include <string.h>

error_t answer_args_parse(int key, char *arg, struct argp_state *state, struct answer_args *args) {
    switch (key) {
    case KEY_EFFECT:
        args->effect_name = arg;
        return 0;
    case KEY_REFERENCE:
        if (!strcmp(arg, "truth")) args->truth = true;
        else list_add(&args->references, arg, state);
        return 0;
    case KEY_CACHE:
        args->cache_asked = arg;
        return 0;
    case KEY_RAYS:
        args->rays = arg_uint("rays", arg, 1, 1 << 20, state);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

void answer_args_check(const struct answer_args *args, size_t captures, struct argp_state *state) {
    if (args->truth && args->references.count) argp_error(state, "--reference: expected either runs or truth");
    if (args->references.count && args->references.count != captures)
        argp_error(state, "--reference: expected one run for each of %zu captures, found %zu", captures,
                   args->references.count);
}

bool answer_args_effect(struct answer_args *args, const struct command *command, const struct glint_pipeline *pipeline,
                        const struct list *captures, struct glint_error *err) {
    const bool traced = !args->truth && !args->references.count;
    if (traced) args->cache = pipeline_args_cache(args->cache_asked);
    args->effect = effect_find(command, args->effect_name, pipeline, traced, args->truth ? captures : NULL, err);
    return args->effect != NULL;
}

void answer_args_finish(struct answer_args *args) {
    list_free(&args->references);
    free(args->cache);
    args->cache = NULL;
}

struct glint_judge_options answer_args_judge(const struct answer_args *args, const char *folder, size_t capture) {
    return (struct glint_judge_options){.effect = args->effect,
                                        .reference = !args->truth,
                                        .truth = args->truth,
                                        .reference_run =
                                            args->references.count ? args->references.items[capture] : NULL,
                                        .reference_folder = folder,
                                        .cache = args->cache,
                                        .reference_rays = args->rays};
}

bool answer_args_metric(const char *name, enum glint_metric *metric, struct glint_error *err) {
    uint32_t bits = 1u << *metric;
    if (name && !glint_metrics_parse(name, &bits, err)) return false;
    if (bits & (bits - 1)) return glint_fail(err, GLINT_ERROR_USAGE, "--metric %s: expected one metric", name);
    int first = 0;
    while (!(bits >> first & 1)) first++;
    *metric = (enum glint_metric)first;
    return true;
}
