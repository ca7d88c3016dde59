/* Cases that replay small captures and check images of passes. */
#ifndef GLINT_SELFTEST_REPLAY_CASE_H
#define GLINT_SELFTEST_REPLAY_CASE_H

#include "harness/case.h"
#include "oracles/end_reason_names.h"
#include "oracles/noise.h"
#include "oracles/plain_capture.h"

/* The first error is sticky: after it nothing runs, and images are NULL. */
struct case_run {
    const struct case_context *context;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
    struct glint_capture *capture;
    struct glint_error *err;
    bool ok;
    /* Set by cases with large images. */
    bool half;                  /* images in their declared formats, not floats */
    const char *const *outputs; /* images that are read, NULL-terminated; NULL: any */
};

struct replay_case {
    const char *name, *what, *unit;
    double bound;
    const char *reason;
    void (*check)(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding);
    const char *use; /* the argument of `check` for case_run_pipeline() */
    int number;      /* distinguishes cases with the same `check` */
    bool slow;       /* skipped in quick runs */
};

struct replay_case_list {
    const struct replay_case *items;
    size_t count;
};

/* Words: "slot=variant" adds to the pipeline, "slot.parameter=value" sets a parameter. */
void case_run_pipeline(struct case_run *run, const char *words);
/* Runs with floats, diagnostics and all passes. */
void case_run_plain(struct case_run *run, const struct plain *plain);
/* Runs the pipeline on the file at `path`. */
void case_run_file(struct case_run *run, const char *path);
const char *case_run_path(const struct case_run *run, const char *name, char path[4096]);
/* Reads an image of the last run; the caller frees. width and height may be NULL. */
float *case_run_floats(struct case_run *run, const char *name, uint32_t *width, uint32_t *height);
uint32_t *case_run_uints(struct case_run *run, const char *name, uint32_t *width, uint32_t *height);

bool replay_cases_run(const struct replay_case_list *const *lists, size_t count, const struct case_context *context,
                      const bool *selected, struct glint_selftest_finding *findings, struct glint_error *err);
size_t replay_cases_count(const struct replay_case_list *const *lists, size_t count);
struct glint_selftest_case replay_cases_get(const struct replay_case_list *const *lists, size_t i);

/* GROUP_group, a group of lists of replay cases. */
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
