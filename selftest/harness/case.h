/* Groups of cases, and the findings of cases. */
#ifndef GLINT_SELFTEST_CASE_H
#define GLINT_SELFTEST_CASE_H

#include "glint/selftest.h"

/* The environment of the cases of a group. */
struct case_context {
    struct glint_device *device;
    const char *folder; /* the group's temporary folder */
    bool quick;
    double *filter_step; /* measured on first use (texture_filter.h); NaN before */
    glint_progress progress;
    void *user;
};

struct case_group {
    const char *name, *what;
    size_t (*count)(void);
    struct glint_selftest_case (*get)(size_t i);
    /* Checks the selected cases. Groups may run in parallel, each with its own device. */
    bool (*run)(const struct case_context *context, const bool *selected, struct glint_selftest_finding *findings,
                struct glint_error *err);
};

/* Adds the error of a compared value, and notes its place if it is the largest so far. A NaN counts as infinite. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void finding_compare(struct glint_selftest_finding *finding, double error, const char *format, ...);

/* Writes a text to a file, overwriting it. */
bool case_write_text(const char *path, const char *text, struct glint_error *err);

#endif
