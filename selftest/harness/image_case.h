/* Cases of functions that read images or work as a workgroup: a pass, or a shader that replaces one, runs, and its result is compared
   texel by texel. They are the second part of the group "functions". */
#ifndef GLINT_SELFTEST_IMAGE_CASE_H
#define GLINT_SELFTEST_IMAGE_CASE_H

#include "harness/frames.h"

struct image_case {
    struct glint_selftest_case about;
    bool (*check)(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                  struct glint_error *err);
    const char *glsl; /* the body of the replacing shader; NULL: the pass itself */
    const void *with; /* for `check` */
};

struct image_list {
    const struct image_case *items;
    size_t count;
};

/* At a tie the result may be either of two values. */
void image_compare(struct glint_selftest_finding *finding, double found, double expected, double otherwise,
                   const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 5, 6)))
#endif
    ;

/* The source of a shader with the declaration of a pass, followed by the text of `format`. */
char *image_shader(const char *variant, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* Reads all values of an image of the last run, which must have this number; the caller frees. NULL with an error. */
void *image_read(struct frames *frames, const char *name, enum glint_type type, size_t values, struct glint_error *err);

#endif
