/* Gives files their names when they are complete. */
#include "complete.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool complete_open(struct complete_file *complete, const char *path, struct glint_error *err) {
    const size_t length = strlen(path) + 32;
    *complete = (struct complete_file){.path = path, .temporary = malloc(length), .file = GLINT_NO_FILE};
    if (!complete->temporary) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    snprintf(complete->temporary, length, "%s.tmp-%ld", path, glint_process_id());
    complete->file = glint_file_create(complete->temporary);
    if (complete->file != GLINT_NO_FILE) return true;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    free(complete->temporary);
    complete->temporary = NULL;
    return false;
}

bool complete_close(struct complete_file *complete, bool ok, bool durable, struct glint_error *err) {
    bool done = !ok || !durable || glint_file_sync(complete->file);
    int reason = errno;
    if (!glint_file_close(complete->file) && done) done = false, reason = errno;
    if (ok && done && !glint_path_replace(complete->temporary, complete->path)) done = false, reason = errno;
    if (ok && !done) ok = glint_fail(err, GLINT_ERROR_IO, "%s: %s", complete->path, strerror(reason));
    if (!ok) glint_path_remove(complete->temporary);
    free(complete->temporary);
    *complete = (struct complete_file){.file = GLINT_NO_FILE};
    return ok;
}
