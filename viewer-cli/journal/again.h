/* A study whose device is lost in the middle goes on with a new one. */
#ifndef GLINT_VIEWER_AGAIN_H
#define GLINT_VIEWER_AGAIN_H

#include "command.h"
#include "glint/judge.h"

/* The steps of a study, such as the points of a sweep, each of which is tried once more if its device is lost. */
struct again {
    const struct command *command;
    struct glint_device *device;
    struct glint_judge *const
        *judges; /* all of the device, that of judge i at the byte `stride` · i; any may be NULL */
    size_t count, stride;
    bool tried; /* the step was; set it to false when a step begins */
};
/* Whether to try a step once more that failed with this error: the device was lost, which a note says, and is there again. The error is then none.
   Otherwise it is false; if the device was lost, the error also names the step, in which it was lost twice, given up, or did not come back. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
bool again_try(struct again *again, struct glint_error *err, const char *step, ...);

#endif
