/* A study whose device is lost in the middle goes on with a new one, once a step: a step that loses the device each time would never end. A device that was given
   up is not replaced, since the same shader would keep the next one busy, too. */
#include "journal/again.h"

#include <stdarg.h>
#include <stdio.h>

static struct glint_judge *judge_of(const struct again *again, size_t i) {
    const void *at = (const char *)again->judges + i * again->stride;
    return *(struct glint_judge *const *)at;
}

static bool return_all(const struct again *again, struct glint_error *err) {
    for (size_t i = 0; i < again->count; i++)
        if (judge_of(again, i)) glint_judge_leave(judge_of(again, i));
    if (!glint_device_reopen(again->device, err)) return false;
    for (size_t i = 0; i < again->count; i++)
        if (judge_of(again, i) && !glint_judge_return(judge_of(again, i), err)) return false;
    return true;
}

static bool fail_step(const char *step, const char *how, struct glint_error *err) {
    const struct glint_error own = *err;
    return glint_fail(err, own.code, "%s%s: %s", step, how, own.message);
}

bool again_try(struct again *again, struct glint_error *err, const char *format, ...) {
    char step[1100];
    va_list args;
    if (!glint_device_lost(again->device)) return false;
    va_start(args, format);
    vsnprintf(step, sizeof step, format, args);
    va_end(args);
    if (glint_device_given_up(again->device)) return fail_step(step, "", err);
    if (again->tried) return fail_step(step, ", tried twice", err);
    again->tried = true;
    command_note(again->command, "%s: %s; trying again", step, err->message);
    *err = (struct glint_error){0};
    return return_all(again, err) || fail_step(step, ", tried again", err);
}
