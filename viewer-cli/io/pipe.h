/* "-" as a file name. EXR files need seeking, so stdin and stdout go through temporary files. */
#ifndef GLINT_VIEWER_PIPE_H
#define GLINT_VIEWER_PIPE_H

#include "io/temporary.h"

struct pipe {
    struct temporary folder; /* of the temporary file; pipe_finish removes it */
    char path[256];          /* the file, "" if there is none */
};

/* Returns `path`, or for "-" a temporary file with the contents of stdin; NULL on failure. */
const char *pipe_input(struct pipe *pipe, const char *path, struct glint_error *err);
/* Returns `path`, or for "-" a temporary file that pipe_output_flush copies to stdout. */
const char *pipe_output(struct pipe *pipe, const char *path, struct glint_error *err);
bool pipe_output_flush(const struct pipe *pipe, struct glint_error *err);
void pipe_finish(struct pipe *pipe);

#endif
