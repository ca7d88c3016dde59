/* The options that sweep, blame and tune share: what errors are against. */
#ifndef GLINT_VIEWER_ANSWER_ARGS_H
#define GLINT_VIEWER_ANSWER_ARGS_H

#include "options/args.h"
#include "glint/judge.h"

struct answer_args {
    struct list references; /* run folders, one for each capture, or none */
    bool truth;             /* the truth in the captures instead */
    uint32_t rays;          /* of a reference that is traced; 0: the judge's own number */
};

enum { KEY_REFERENCE = 768, KEY_RAYS };

/* Reads --reference and --rays; ARGP_ERR_UNKNOWN for any other key. */
error_t answer_args_parse(int key, char *arg, struct argp_state *state, struct answer_args *args);
/* When all arguments are read. */
void answer_args_check(const struct answer_args *args, size_t captures, struct argp_state *state);
void answer_args_finish(struct answer_args *args);
/* What a judge of that capture needs for it; a reference that is traced is kept in the folder. */
struct glint_judge_options answer_args_judge(const struct answer_args *args, const char *folder, size_t capture);
/* --metric's single name; without one *metric stays. */
bool answer_args_metric(const char *name, enum glint_metric *metric, struct glint_error *err);
static inline enum glint_target answer_args_kind(const struct answer_args *args) {
    return args->truth ? GLINT_TARGET_TRUTH : GLINT_TARGET_REFERENCE;
}

#endif
