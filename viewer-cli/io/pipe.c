/* "-" as a file name. */
#include "io/pipe.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/console.h"

static bool copy(FILE *from, FILE *to, const char *what, struct glint_error *err) {
    char buffer[1 << 16];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, from)) > 0;)
        if (fwrite(buffer, 1, n, to) != n) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", what, strerror(errno));
    if (ferror(from)) return glint_fail(err, GLINT_ERROR_IO, "%s: %s", what, strerror(errno));
    return true;
}

/* An open file, or -1. */
static int make_temporary(struct pipe *pipe, const char *what, struct glint_error *err) {
    const char *folder = getenv("TMPDIR");
    int length = snprintf(pipe->path, sizeof pipe->path, "%s/glint-%s-XXXXXX", folder ? folder : "/tmp", what);
    int file = length < (int)sizeof pipe->path ? mkstemp(pipe->path) : -1;
    if (file >= 0) return file;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", pipe->path, strerror(errno));
    pipe->path[0] = '\0';
    return -1;
}

const char *pipe_input(struct pipe *pipe, const char *path, struct glint_error *err) {
    *pipe = (struct pipe){0};
    if (strcmp(path, "-") != 0) return path;
    const int temporary = make_temporary(pipe, "stdin", err);
    if (temporary < 0) return NULL;
    FILE *file = fdopen(temporary, "wb");
    if (!file) close(temporary);
    bool ok =
        file ? copy(stdin, file, "stdin", err) : glint_fail(err, GLINT_ERROR_IO, "%s: %s", pipe->path, strerror(errno));
    if (file && fclose(file) != 0 && ok) ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", pipe->path, strerror(errno));
    return ok ? pipe->path : NULL;
}

const char *pipe_output(struct pipe *pipe, const char *path, struct glint_error *err) {
    *pipe = (struct pipe){0};
    if (strcmp(path, "-") != 0) return path;
    const int temporary = make_temporary(pipe, "stdout", err);
    if (temporary < 0) return NULL;
    close(temporary);
    return pipe->path;
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
    if (pipe->path[0]) unlink(pipe->path);
    pipe->path[0] = '\0';
}
