/* The options of sweep, blame and tune that choose the effect, and the reference or truth for its errors. */
#ifndef GLINT_VIEWER_ANSWER_ARGS_H
#define GLINT_VIEWER_ANSWER_ARGS_H

#include "options/args.h"
#include "options/effect_args.h"
#include "options/pipeline_args.h"
#include "glint/judge.h"

struct answer_args {
    struct list references; /* run folders, one for each capture, or empty */
    const char *effect_name;
    const struct glint_effect *effect; /* whose errors are measured */
    bool truth;                        /* uses the truth in the captures */
    uint32_t rays;                     /* of a traced reference; 0: the judge's default */
    const char *cache_asked;           /* --cache, or NULL */
    char *cache;                       /* the folder in which traced references are found, or NULL */
};

enum { KEY_REFERENCE = 768, KEY_RAYS };

/* The options --rays and --cache of a reference that is traced. */
#define TRACED_OPTIONS                                                                                                 \
    {"rays", KEY_RAYS, "N", 0, "Rays per pixel of the reference that is traced (default 64)", 0},                      \
        CACHE_OPTION("traced references", "")

/* Reads --effect, --reference, --rays and --cache; ARGP_ERR_UNKNOWN for any other key. */
error_t answer_args_parse(int key, char *arg, struct argp_state *state, struct answer_args *args);
/* Call after all arguments are parsed. */
void answer_args_check(const struct answer_args *args, size_t captures, struct argp_state *state);
/* Finds the effect for a pipeline, by its captures if their truth is used, and the cache folder for references that are traced. */
bool answer_args_effect(struct answer_args *args, const struct command *command, const struct glint_pipeline *pipeline,
                        const struct list *captures, struct glint_error *err);
void answer_args_finish(struct answer_args *args);
/* The options of a judge for that capture; a reference that is traced is stored in the folder. */
struct glint_judge_options answer_args_judge(const struct answer_args *args, const char *folder, size_t capture);
/* Parses the single name of --metric; without a name, *metric does not change. */
bool answer_args_metric(const char *name, enum glint_metric *metric, struct glint_error *err);
static inline enum glint_target answer_args_kind(const struct answer_args *args) {
    return args->truth ? GLINT_TARGET_TRUTH : GLINT_TARGET_REFERENCE;
}

#endif
