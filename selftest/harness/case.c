/* Findings of cases, and files written by cases. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "harness/case.h"

void finding_compare(struct glint_selftest_finding *finding, double error, const char *format, ...) {
    if (isnan(error)) error = INFINITY;
    finding->values++;
    if (error <= finding->worst) return;
    va_list arguments;
    va_start(arguments, format);
    finding->worst = error;
    vsnprintf(finding->at, sizeof finding->at, format, arguments);
    va_end(arguments);
}

bool case_write_text(const char *path, const char *text, struct glint_error *err) {
    FILE *file = fopen(path, "wb");
    bool ok = file && fputs(text, file) >= 0;
    if (file) ok = fclose(file) == 0 && ok;
    return ok || glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
}
