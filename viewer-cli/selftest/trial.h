/* Cases that replay small captures and look at the images of their passes. */
#ifndef GLINT_VIEWER_SELFTEST_TRIAL_H
#define GLINT_VIEWER_SELFTEST_TRIAL_H

#include "ends.h"
#include "noise.h"
#include "plain_capture.h"
#include "selftest.h"

/* The first error sticks: after it nothing is done any more, and images are NULL. */
struct trial {
    const struct selftest *test;
    struct glint_replay *replay;
    struct glint_pipeline *pipeline;
    struct glint_capture *capture;
    struct glint_error *err;
    bool ok;
    /* Of a case; large pictures need them. */
    bool half;                  /* images as passes declare them, not all in float */
    const char *const *outputs; /* images that it looks at, NULL-terminated; NULL: any */
};

struct trial_case {
    const char *name, *what, *unit;
    double bound;
    const char *reason;
    void (*check)(struct trial *trial, const struct trial_case *c, struct selftest_finding *finding);
    const char *use; /* what `check` gives to trial_use() */
    int number;      /* which one, where a check serves several cases */
    bool slow;       /* left out of a quick run */
};

struct trial_list {
    const struct trial_case *items;
    size_t count;
};

/* Words: "slot=variant" make the pipeline, "slot.parameter=value" set it. */
void trial_use(struct trial *trial, const char *words);
/* Everything in float and with diagnostics; no pass is left out for having nothing to do. */
void trial_run(struct trial *trial, const struct plain *plain);
/* What the file at `path` holds, through the pipeline. */
void trial_run_file(struct trial *trial, const char *path);
const char *trial_path(const struct trial *trial, const char *name, char path[4096]);
/* Images of the last run; the caller frees. width and height may be NULL. */
float *trial_floats(struct trial *trial, const char *name, uint32_t *width, uint32_t *height);
uint32_t *trial_uints(struct trial *trial, const char *name, uint32_t *width, uint32_t *height);

/* One more value compared; says where when it is the worst. A NaN is an infinite error. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void compared(struct selftest_finding *finding, double error, const char *format, ...);

bool trial_cases(const struct trial_list *const *lists, size_t count, const struct selftest *test, const bool *chosen,
                 struct selftest_finding *findings, struct glint_error *err);
size_t trial_count(const struct trial_list *const *lists, size_t count);
struct selftest_case trial_get(const struct trial_list *const *lists, size_t i);

/* A group that is lists of trials. */
#define TRIAL_GROUP(group, name, what, ...)                                                                            \
    static const struct trial_list *const lists[] = {__VA_ARGS__};                                                     \
    enum { LISTS = sizeof lists / sizeof *lists };                                                                     \
    static size_t count(void) {                                                                                        \
        return trial_count(lists, LISTS);                                                                              \
    }                                                                                                                  \
    static struct selftest_case get(size_t i) {                                                                        \
        return trial_get(lists, i);                                                                                    \
    }                                                                                                                  \
    static bool run(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,                \
                    struct glint_error *err) {                                                                         \
        return trial_cases(lists, LISTS, test, chosen, findings, err);                                                 \
    }                                                                                                                  \
    const struct selftest_group group = {name, what, count, get, run}

#endif
