/* "-" as a file: EXR files need seeking, so what comes or goes through a pipe passes through a temporary file. */
#ifndef GLINT_VIEWER_PIPE_H
#define GLINT_VIEWER_PIPE_H

#include "glint/common.h"

struct pipe {
    char path[256]; /* the temporary file, "" for none; removed by pipe_finish */
};

/* `path`, or for "-" a temporary file with all of stdin; NULL on failure. */
const char *pipe_input(struct pipe *pipe, const char *path, struct glint_error *err);
/* `path`, or for "-" a temporary file that pipe_output_flush copies to stdout. */
const char *pipe_output(struct pipe *pipe, const char *path, struct glint_error *err);
bool pipe_output_flush(const struct pipe *pipe, struct glint_error *err);
void pipe_finish(struct pipe *pipe);

#endif
