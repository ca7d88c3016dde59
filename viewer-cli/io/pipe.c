/* "-" as a file name. */
#include "io/pipe.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/console.h"

static bool copy(FILE *from, FILE *to, const char *what, struct glint_error *err) {
    char buffer[1 << 16];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, from)) > 0;)
        if (fwrite(buffer, 1, n, to) != n) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", what, strerror(errno));
    if (ferror(from)) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", what, strerror(errno));
    return true;
}

static bool make_temporary(struct pipe *pipe, const char *what, struct glint_error *err) {
    if (!temporary_make(&pipe->folder, what, err)) return false;
    snprintf(pipe->path, sizeof pipe->path, "%s/%s", pipe->folder.path, what);
    return true;
}

const char *pipe_input(struct pipe *pipe, const char *path, struct glint_error *err) {
    *pipe = (struct pipe){0};
    if (strcmp(path, "-") != 0) return path;
    if (!make_temporary(pipe, "stdin", err)) return NULL;
    FILE *file = fopen(pipe->path, "wb");
    bool ok =
        file ? copy(stdin, file, "stdin", err) : glint_fail(err, GLINT_ERROR_IO, "%s: %s", pipe->path, strerror(errno));
    if (file && fclose(file) != 0 && ok) ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", pipe->path, strerror(errno));
    return ok ? pipe->path : NULL;
}

const char *pipe_output(struct pipe *pipe, const char *path, struct glint_error *err) {
    *pipe = (struct pipe){0};
    if (strcmp(path, "-") != 0) return path;
    return make_temporary(pipe, "stdout", err) ? pipe->path : NULL;
}

bool pipe_output_flush(const struct pipe *pipe, struct glint_error *err) {
    if (!pipe->path[0]) return true;
    FILE *file = fopen(pipe->path, "rb");
    if (!file) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", pipe->path, strerror(errno));
    console_plain(true);
    bool ok = copy(file, stdout, "stdout", err);
    fclose(file);
    return ok;
}

void pipe_finish(struct pipe *pipe) {
    temporary_remove(&pipe->folder);
    pipe->path[0] = '\0';
}
