/* Cases of functions that read images or work as a workgroup: a pass, or a stand-in for one, is run, and what it stores is
   compared texel by texel. They are the second half of the group "functions". */
#ifndef GLINT_SELFTEST_IMAGE_CASE_H
#define GLINT_SELFTEST_IMAGE_CASE_H

#include "harness/frames.h"

struct image_case {
    struct glint_selftest_case about;
    bool (*check)(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                  struct glint_error *err);
    const char *glsl; /* what a stand-in evaluates; NULL: a pass as it is */
    const void *with; /* for `check` */
};

struct image_list {
    const struct image_case *items;
    size_t count;
};

/* found and expected may be either of two where a decision is a tie. */
void image_compare(struct glint_selftest_finding *finding, double found, double expected, double otherwise,
                   const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 5, 6)))
#endif
    ;

/* A shader of a pass with its declaration included, and what `format` says as the rest of it. */
char *image_shader(const char *variant, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* All values of an image of the last run, which has so many; the caller frees. NULL: err says why. */
void *image_read(struct frames *frames, const char *name, enum glint_type type, size_t values, struct glint_error *err);

#endif
