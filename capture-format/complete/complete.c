/* Gives files their names when they are complete. */
#include "complete.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *complete_temporary(const char *path) {
    const size_t length = strlen(path) + sizeof GLINT_TEMPORARY + GLINT_TEMPORARY_DIGITS;
    char *name = malloc(length);
    if (name) snprintf(name, length, "%s" GLINT_TEMPORARY "%0*x", path, (int)GLINT_TEMPORARY_DIGITS, glint_random());
    return name;
}

static bool open_as(struct complete_file *complete, const char *path, bool secret, struct glint_error *err) {
    *complete = (struct complete_file){.path = path, .file = GLINT_NO_FILE};
    glint_path_remove_temporaries(path);
    do {
        free(complete->temporary);
        if (!(complete->temporary = complete_temporary(path)))
            return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
        complete->file = glint_file_create_temporary(complete->temporary, secret);
    } while (complete->file == GLINT_NO_FILE && errno == EEXIST);
    if (complete->file != GLINT_NO_FILE) return true;
    glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    free(complete->temporary);
    complete->temporary = NULL;
    return false;
}

bool complete_open(struct complete_file *complete, const char *path, struct glint_error *err) {
    return open_as(complete, path, false, err);
}

bool complete_open_secret(struct complete_file *complete, const char *path, struct glint_error *err) {
    return open_as(complete, path, true, err);
}

static bool fail_at(const char *path, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
}

bool complete_close(struct complete_file *complete, bool ok, bool durable, struct glint_error *err) {
    struct glint_file_info old;
    const bool given = ok, sync = durable || glint_path_describe(complete->path, &old);
    if (ok && sync && !glint_file_sync(complete->file)) ok = fail_at(complete->path, err);
    if (!ok) glint_file_close(complete->file);
    else if (!glint_file_close_as(complete->file, complete->temporary, complete->path))
        ok = fail_at(complete->path, err);
    if (!ok) glint_path_remove(complete->temporary);
    free(complete->temporary);
    if (given && ok && sync && !glint_path_sync_folder(complete->path)) ok = fail_at(complete->path, err);
    *complete = (struct complete_file){.file = GLINT_NO_FILE};
    return ok;
}

static bool sync_file(const char *path) {
    const glint_file file = glint_file_open(path);
    const bool ok = file != GLINT_NO_FILE && glint_file_sync(file);
    const int reason = errno;
    if (file != GLINT_NO_FILE) glint_file_close(file);
    errno = reason;
    return ok;
}

bool complete_rename(const char *from, const char *to, struct glint_error *err) {
    return (sync_file(from) && glint_path_replace(from, to) && glint_path_sync_folder(to)) || fail_at(to, err);
}
