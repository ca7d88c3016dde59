/* Several faults gathered into one error message. */
#include "faults.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void faults_add(struct faults *faults, enum glint_code code, const char *format, ...) {
    char line[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (faults->count++ == 0) faults->code = code;
    size_t used = strlen(faults->text);
    if (used + strlen(line) + 3 > sizeof faults->text) {
        faults->left_out++;
        return;
    }
    snprintf(faults->text + used, sizeof faults->text - used, "%s%s", used ? "; " : "", line);
}

bool faults_none(const struct faults *faults, const char *where, struct glint_error *err) {
    if (!faults->count) return true;
    if (faults->left_out)
        return glint_fail(err, faults->code, "%s: %s; and %zu more", where, faults->text, faults->left_out);
    return glint_fail(err, faults->code, "%s: %s", where, faults->text);
}
