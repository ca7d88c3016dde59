/* What a group of cases is, and how a case tells what it found. */
#ifndef GLINT_SELFTEST_CASE_H
#define GLINT_SELFTEST_CASE_H

#include "glint/selftest.h"

/* What the cases of a group run with. */
struct case_context {
    struct glint_device *device;
    const char *folder; /* temporary, the group's own */
    bool quick;
    double *filter_step; /* measured when first asked for (texture_filter.h); NaN: not yet */
    glint_progress progress;
    void *user;
};

struct case_group {
    const char *name, *what;
    size_t (*count)(void);
    struct glint_selftest_case (*get)(size_t i);
    /* Checks the selected cases. Several groups at a time, on a device each. */
    bool (*run)(const struct case_context *context, const bool *selected, struct glint_selftest_finding *findings,
                struct glint_error *err);
};

/* One more value compared; says where when it is the worst. A NaN is an infinite error. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void finding_compare(struct glint_selftest_finding *finding, double error, const char *format, ...);

/* Writes a text to a file, over what was there. */
bool case_write_text(const char *path, const char *text, struct glint_error *err);

#endif
