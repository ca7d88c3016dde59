/* Creates error values. */
#include "glint/common.h"

#include <stdarg.h>
#include <stdio.h>

#include "shown.h"

bool glint_fail(struct glint_error *err, enum glint_code code, const char *format, ...) {
    if (!err) return false;
    err->code = code;
    va_list args;
    va_start(args, format);
    char text[sizeof err->message];
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    /* Names come from files and may contain anything, but a message is one line that a terminal prints as it is. */
    shown_text(err->message, sizeof err->message, text);
    return false;
}
