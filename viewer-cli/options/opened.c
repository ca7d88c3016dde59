/* The objects of commands that work on one capture. */
#include "options/opened.h"

bool opened_init(struct opened *opened, const struct pipeline_args *args, const char *capture,
                 struct glint_error *err) {
    if (!opened->pipeline) opened->pipeline = pipeline_args_create(args, err);
    const char *path = opened->pipeline ? pipe_input(&opened->pipe, capture, err) : NULL;
    return path && (opened->capture = glint_capture_open(path, NULL, err)) &&
           (opened->device = pipeline_args_device(args, err)) &&
           (opened->replay = glint_replay_create(opened->device, err));
}

void opened_finish(struct opened *opened) {
    glint_replay_destroy(&opened->replay);
    glint_device_destroy(&opened->device);
    glint_capture_close(&opened->capture);
    glint_pipeline_destroy(&opened->pipeline);
    pipe_finish(&opened->pipe);
}
