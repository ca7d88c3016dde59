/* Cases that replay small captures and look at the images of their passes. */
#ifndef GLINT_SELFTEST_REPLAY_CASE_H
#define GLINT_SELFTEST_REPLAY_CASE_H

#include "harness/case.h"
#include "oracles/end_reason_names.h"
#include "oracles/noise.h"
#include "oracles/plain_capture.h"

/* The first error sticks: after it nothing is done any more, and images are NULL. */
struct case_run {
    const struct case_context *context;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
    struct glint_capture *capture;
    struct glint_error *err;
    bool ok;
    /* Of a case; large pictures need them. */
    bool half;                  /* images as passes declare them, not all in float */
    const char *const *outputs; /* images that it looks at, NULL-terminated; NULL: any */
};

struct replay_case {
    const char *name, *what, *unit;
    double bound;
    const char *reason;
    void (*check)(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding);
    const char *use; /* what `check` gives to case_run_pipeline() */
    int number;      /* which one, where a check serves several cases */
    bool slow;       /* left out of a quick run */
};

struct replay_case_list {
    const struct replay_case *items;
    size_t count;
};

/* Words: "slot=variant" make the pipeline, "slot.parameter=value" set it. */
void case_run_pipeline(struct case_run *run, const char *words);
/* Everything in float and with diagnostics; no pass is left out for having nothing to do. */
void case_run_plain(struct case_run *run, const struct plain *plain);
/* What the file at `path` holds, through the pipeline. */
void case_run_file(struct case_run *run, const char *path);
const char *case_run_path(const struct case_run *run, const char *name, char path[4096]);
/* Images of the last run; the caller frees. width and height may be NULL. */
float *case_run_floats(struct case_run *run, const char *name, uint32_t *width, uint32_t *height);
uint32_t *case_run_uints(struct case_run *run, const char *name, uint32_t *width, uint32_t *height);

bool replay_cases_run(const struct replay_case_list *const *lists, size_t count, const struct case_context *context,
                      const bool *selected, struct glint_selftest_finding *findings, struct glint_error *err);
size_t replay_cases_count(const struct replay_case_list *const *lists, size_t count);
struct glint_selftest_case replay_cases_get(const struct replay_case_list *const *lists, size_t i);

/* GROUP_group, a group that is lists of replay cases. */
#define REPLAY_CASE_GROUP(group, what, ...)                                                                            \
    static const struct replay_case_list *const group##_lists[] = {__VA_ARGS__};                                       \
    static size_t group##_count(void) {                                                                                \
        return replay_cases_count(group##_lists, sizeof group##_lists / sizeof *group##_lists);                        \
    }                                                                                                                  \
    static struct glint_selftest_case group##_get(size_t i) {                                                          \
        return replay_cases_get(group##_lists, i);                                                                     \
    }                                                                                                                  \
    static bool group##_run(const struct case_context *context, const bool *selected,                                  \
                            struct glint_selftest_finding *findings, struct glint_error *err) {                        \
        return replay_cases_run(group##_lists, sizeof group##_lists / sizeof *group##_lists, context, selected,        \
                                findings, err);                                                                        \
    }                                                                                                                  \
    const struct case_group group##_group = {#group, what, group##_count, group##_get, group##_run}

#endif
