/* Handles violated rules. */
#include "check.h"

#include <stdarg.h>
#include <stdio.h>

bool glint_violation(struct glint_check *check, enum glint_rule rule, const char *part, const char *channel,
                     const char *format, ...) {
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    struct glint_error err = {0};
    glint_fail(&err, rule == GLINT_RULE_VERSION ? GLINT_ERROR_UNSUPPORTED : GLINT_ERROR_FORMAT, "%s: %s%s%s%s%s%s",
               check->file, part ? "part " : "", part ? part : "", part ? ": " : "", channel ? channel : "",
               channel ? ": " : "", text);
    check->violations++;
    if (!check->report) {
        if (check->err) *check->err = err;
        return false;
    }
    check->report(check->user, glint_rule_rows()[rule].name, err.message);
    return true;
}
