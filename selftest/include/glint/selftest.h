/* libglint-selftest: what a device makes of the passes, case by case. A case is a claim with a bound and the bound's reason; cases
   that are checked by the same means form a group. The references are closed forms and traversals in double precision: nothing of
   the shaders is used for them. */
#ifndef GLINT_SELFTEST_H
#define GLINT_SELFTEST_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_selftest;

struct glint_selftest_case {
    const char *name, *what;
    const char *source; /* what is evaluated: GLSL, or NULL */
    const char *unit;   /* of error and bound: "ULP", "absolute" */
    double bound;
    const char *reason; /* why the bound is what it is */
};

struct glint_selftest_finding {
    double worst;        /* error, in the case's unit; +inf for a NaN or a wrong decision */
    size_t values, ties; /* how many were compared; ties: decisions, such as hit or miss, that rounding made */
    char at[320];        /* the worst one's input, what was found and what was expected */
    bool left_out;       /* takes too long for a quick run */
};

/* The selected cases of a group. */
struct glint_selftest_group {
    const char *name, *what;
    size_t count;
    const struct glint_selftest_case *cases;
    const struct glint_selftest_finding *findings; /* of each case; zero until it has run */
    double seconds;
};

struct glint_selftest_options {
    const char *device; /* as in struct glint_device_options */
    const char *passes; /* folder whose shaders are checked instead of those built in; NULL: none */
    bool quick;         /* fewer values, and no case that takes long */
};

/* Selects the cases that have one of the texts of `only`, NULL-terminated, in their name, their claim, their source, or their
   group's name; all where `only` is NULL. GLINT_ERROR_USAGE where no case has. destroy accepts NULL and clears the pointer. */
struct glint_selftest *glint_selftest_create(const char *const *only, struct glint_error *err);
void glint_selftest_destroy(struct glint_selftest **selftest);

/* Runs the selected cases, groups side by side, each worker on a device and in a temporary folder of its own; progress is called
   from their threads, one at a time. False, with an error, where a group could not be run to its end: a case that fails its bound
   is not an error. One thread at a time; a second run replaces the findings. */
bool glint_selftest_run(struct glint_selftest *selftest, const struct glint_selftest_options *options,
                        glint_progress progress, void *user, struct glint_error *err);

/* Groups without a selected case have a count of 0. Both live as long as the self-test. */
size_t glint_selftest_group_count(const struct glint_selftest *selftest);
const struct glint_selftest_group *glint_selftest_get_group(const struct glint_selftest *selftest, size_t index);
/* The device that the cases ran on. */
const struct glint_device_info *glint_selftest_device(const struct glint_selftest *selftest);

/* Within its bound. A case that compared nothing does not pass. */
bool glint_selftest_passes(const struct glint_selftest_case *c, const struct glint_selftest_finding *finding);

#ifdef __cplusplus
}
#endif

#endif
