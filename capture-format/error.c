/* Creates error values. */
#include "glint/common.h"

#include <stdarg.h>
#include <stdio.h>

bool glint_fail(struct glint_error *err, enum glint_code code, const char *format, ...) {
    if (!err) return false;
    err->code = code;
    va_list args;
    va_start(args, format);
    vsnprintf(err->message, sizeof err->message, format, args);
    va_end(args);
    /* Names come from files and may contain newlines, but a message is one line. */
    for (char *c = err->message; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127) *c = '?';
    return false;
}
