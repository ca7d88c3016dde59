/* The error of a failed allocation. */
#ifndef GLINT_STUDY_NO_MEMORY_H
#define GLINT_STUDY_NO_MEMORY_H

#include "glint/common.h"

static inline bool no_memory(struct glint_error *err, const char *what) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", what);
}

#endif
