/* Creates folders. */
#include "glint/common.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "system.h"

/* Parents are only created when the folder itself cannot be, so that the roots of drives and shares are left alone. */
static bool make_folder(char *path, struct glint_error *err) {
    struct glint_file_info found;
    if (glint_path_create_folder(path)) return true;
    size_t parent = glint_path_folder(path);
    if ((errno == ENOENT || errno == ENOTDIR) && parent > 1 && path[parent - 1] != ':') {
        const char removed = path[--parent];
        path[parent] = 0;
        const bool ok = make_folder(path, err);
        path[parent] = removed;
        if (!ok) return false;
        if (glint_path_create_folder(path)) return true;
    }
    const int reason = errno;
    if (glint_path_describe(path, &found))
        return found.kind == GLINT_FILE_FOLDER ||
               glint_fail(err, GLINT_ERROR_IO, "%s: expected a folder, found something else", path);
    return glint_fail(err, GLINT_ERROR_IO, "folder %s: %s", path, strerror(reason));
}

bool glint_make_folder(const char *folder, struct glint_error *err) {
    char *path = strdup(folder);
    const bool ok = path ? make_folder(path, err) : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    free(path);
    return ok;
}
