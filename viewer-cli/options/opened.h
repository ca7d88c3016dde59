/* What a command works with that is about one capture: the capture itself, a pipeline, a device, and a replay on it. */
#ifndef GLINT_VIEWER_OPENED_H
#define GLINT_VIEWER_OPENED_H

#include "io/pipe.h"
#include "options/pipeline_args.h"

struct opened {
    struct pipe pipe;
    struct glint_pipeline *pipeline;
    struct glint_capture *capture;
    struct glint_device *device;
    struct glint_replay *replay;
};

/* capture: "-" is stdin. A pipeline that is there already stays. Finish it after a failure, too. */
bool opened_init(struct opened *opened, const struct pipeline_args *args, const char *capture, struct glint_error *err);
void opened_finish(struct opened *opened);

#endif
