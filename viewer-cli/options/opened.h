/* The objects of commands that work on one capture: the capture, a pipeline, a device, and a replay on it. */
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

/* "-" as capture is stdin. A pipeline that is set is kept. Finish it even if this fails. */
bool opened_init(struct opened *opened, const struct pipeline_args *args, const char *capture, struct glint_error *err);
void opened_finish(struct opened *opened);

#endif
