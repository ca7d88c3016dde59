/* Handles violated rules: reader and writer stop at the first one, validation reports all. */
#ifndef GLINT_CHECK_H
#define GLINT_CHECK_H

#include "registry.h"

struct glint_check {
    const char *file;
    glint_report report; /* NULL: stop at the first */
    void *user;
    size_t violations;
    struct glint_error *err;
};

/* `part` and `channel` may be NULL. True if checking continues. */
GLINT_PRINTF(5, 6)
bool glint_violation(struct glint_check *check, enum glint_rule rule, const char *part, const char *channel,
                     const char *format, ...);

#endif
