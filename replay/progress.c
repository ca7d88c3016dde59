#include "progress.h"

bool report_progress(glint_progress progress, void *user, const char *what, double done, struct glint_error *err) {
    return !progress || progress(user, what, done) ||
           glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted at %s", what);
}
