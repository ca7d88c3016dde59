/* The self-test: cases, each a claim with a bound and its reason, by groups that know how to check theirs. They know passes and
   their functions by name, which the replay library must not: so they stand beside the program. */
#ifndef GLINT_VIEWER_SELFTEST_H
#define GLINT_VIEWER_SELFTEST_H

#include "glint/replay.h"

struct selftest_case {
    const char *name, *what;
    const char *source; /* what is evaluated: GLSL, or NULL */
    const char *unit;   /* of error and bound: "ULP", "absolute" */
    double bound;
    const char *reason; /* why the bound is what it is */
};

struct selftest_finding {
    double worst;        /* error, in the case's unit; +inf for a NaN or a wrong decision */
    size_t values, ties; /* ties: decisions that rounding made */
    char at[320];        /* input, found, expected */
    bool left_out;       /* too long for a quick run */
};

struct selftest {
    struct glint_device *device;
    const char *folder; /* temporary, the self-test's own */
    bool quick;
    double *filter_step; /* found when first asked for (filter.h); NaN: not yet */
    glint_progress progress;
    void *user;
};

struct selftest_group {
    const char *name, *what;
    size_t (*count)(void);
    struct selftest_case (*get)(size_t i);
    /* Checks the chosen cases. Several groups at a time, on a device each. */
    bool (*run)(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,
                struct glint_error *err);
};

extern const struct selftest_group selftest_functions;
extern const struct selftest_group selftest_geometry;
extern const struct selftest_group selftest_numbers;
extern const struct selftest_group selftest_garbage;
extern const struct selftest_group selftest_sizes;
extern const struct selftest_group selftest_time;
extern const struct selftest_group selftest_invariance;

#endif
