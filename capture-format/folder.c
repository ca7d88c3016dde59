/* Creates folders. */
#include "glint/common.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool make_one_folder(const char *path, struct glint_error *err) {
    struct stat found;
    if (mkdir(path, 0777) == 0 || errno == EEXIST) {
        if (stat(path, &found) == 0 && S_ISDIR(found.st_mode)) return true;
        return glint_fail(err, GLINT_ERROR_IO, "%s: expected a folder, found something else", path);
    }
    return glint_fail(err, GLINT_ERROR_IO, "folder %s: %s", path, strerror(errno));
}

bool glint_make_folder(const char *folder, struct glint_error *err) {
    char *path = strdup(folder);
    bool ok = path || glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    for (char *slash = path; ok && *slash && (slash = strchr(slash + 1, '/'));) {
        *slash = 0;
        ok = make_one_folder(path, err);
        *slash = '/';
    }
    ok = ok && make_one_folder(folder, err);
    free(path);
    return ok;
}
