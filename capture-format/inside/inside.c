/* Opens and reads files of folders that nobody vouches for. */
#include "inside.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool inside_open(glint_file *file, const char *path, uint64_t most, uint64_t *bytes, struct glint_error *err) {
    struct glint_file_info info = {0};
    *file = glint_file_open_unlinked(path);
    const bool opened = *file != GLINT_NO_FILE && glint_file_describe(*file, &info);
    *bytes = info.bytes;
    if (opened && info.kind == GLINT_FILE_REGULAR && info.bytes <= most) return true;
    if (!opened && errno == ELOOP)
        glint_fail(err, GLINT_ERROR_IO, "%s: expected a file, found a symbolic link, which is not followed", path);
    else if (!opened) glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    else if (info.kind != GLINT_FILE_REGULAR)
        glint_fail(err, GLINT_ERROR_IO, "%s: expected a file, found %s", path,
                   info.kind == GLINT_FILE_FOLDER ? "a folder" : "a device or a pipe");
    else
        glint_fail(err, GLINT_ERROR_LIMIT, "%s: expected at most %llu bytes, found %llu", path,
                   (unsigned long long)most, (unsigned long long)info.bytes);
    if (*file != GLINT_NO_FILE) glint_file_close(*file);
    *file = GLINT_NO_FILE;
    return false;
}

char *inside_text(const char *path, size_t most, struct glint_error *err) {
    glint_file file;
    uint64_t bytes;
    size_t got = 0;
    if (!inside_open(&file, path, most, &bytes, err)) return NULL;
    char *text = malloc((size_t)bytes + 1);
    const bool read = text && glint_file_read(file, text, (size_t)bytes, 0, &got);
    const int reason = errno;
    glint_file_close(file);
    if (read) {
        text[got] = 0;
        if (strlen(text) == got) return text;
        glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected text, found a NUL byte at %zu", path, strlen(text));
    } else if (text) glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(reason));
    else glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    free(text);
    return NULL;
}

bool inside_json_fits(const char *path, const char *text, size_t length, struct glint_error *err) {
    enum { MOST_VALUES = 2000000 };
    size_t values = 0;
    bool quoted = false;
    for (size_t i = 0; i < length && values <= MOST_VALUES; i++) {
        if (quoted && text[i] == '\\') i++;
        else if (text[i] == '"') quoted = !quoted;
        else if (!quoted) values += text[i] == ',' || text[i] == '[' || text[i] == '{';
    }
    return values <= MOST_VALUES ||
           glint_fail(err, GLINT_ERROR_LIMIT, "%s: more than %d values, which is the limit", path, MOST_VALUES);
}

char *inside_path(const char *folder, const char *name, struct glint_error *err) {
    char *root = realpath(folder, NULL), *real = NULL;
    const size_t length = root ? strlen(root) : 0, size = length + strlen(name) + 2;
    char *path = root ? malloc(size) : NULL;
    if (path) {
        snprintf(path, size, "%s%s%s", name[0] == '/' ? "" : root, name[0] == '/' ? "" : "/", name);
        real = realpath(path, NULL);
    }
    const int reason = errno;
    const bool below =
        real && name[0] != '/' && (length == 1 || (strncmp(real, root, length) == 0 && real[length] == '/'));
    if (!real && name[0] == '/') glint_fail(err, GLINT_ERROR_IO, "%s: %s", name, strerror(reason));
    else if (!real) glint_fail(err, GLINT_ERROR_IO, "%s/%s: %s", folder, name, strerror(reason));
    else if (!below)
        glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected a file in %s or below, found one outside", name, folder);
    if (!below) {
        free(real);
        real = NULL;
    }
    free(path);
    free(root);
    return real;
}

char *inside_beside(const char *file, const char *name, struct glint_error *err) {
    const size_t length = glint_path_folder(file);
    char *folder = length ? strndup(file, length > 1 ? length - 1 : 1) : strdup(".");
    if (!folder) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", file);
    char *path = folder ? inside_path(folder, name, err) : NULL;
    free(folder);
    return path;
}
