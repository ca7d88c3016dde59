/* Whole text files. */
#include "text_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "inside.h"

/* All of the file, or its first bytes if there are more than `limit`; NULL without memory. */
static char *read_all(FILE *file, size_t limit, size_t *size) {
    enum { FIRST = 4096 };
    char *text = NULL;
    size_t room = FIRST;
    *size = 0;
    do {
        char *larger = realloc(text, room);
        if (!larger) {
            free(text);
            return NULL;
        }
        text = larger;
        *size += fread(text + *size, 1, room - 1 - *size, file);
        room *= 2;
    } while (*size == room / 2 - 1 && *size <= limit);
    return text;
}

char *file_text(const char *path, size_t limit, struct glint_error *err) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
        return NULL;
    }
    size_t size;
    char *text = read_all(file, limit, &size);
    const int failed = ferror(file) ? errno : 0;
    fclose(file);
    if (text && !failed && size <= limit) {
        text[size] = 0;
        if (strlen(text) == size) {
            char *fitted = realloc(text, size + 1);
            return fitted ? fitted : text;
        }
        glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected text, found a NUL byte at %zu", path, strlen(text));
    } else if (!text) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", path);
    else if (failed) glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(failed));
    else glint_fail(err, GLINT_ERROR_LIMIT, "%s: expected at most %zu bytes of text", path, limit);
    free(text);
    return NULL;
}

char *file_text_found(const char *path, size_t limit, struct glint_error *err) {
    char *real = realpath(path, NULL);
    if (!real) glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
    char *text = real ? inside_text(real, limit, err) : NULL;
    free(real);
    return text;
}
