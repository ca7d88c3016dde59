/* Whole text files. */
#include "text_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *file_text(const char *path, size_t limit, struct glint_error *err) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        glint_fail(err, GLINT_ERROR_IO, "%s: %s", path, strerror(errno));
        return NULL;
    }
    size_t size = 0, capacity = 1 << 16;
    char *text = malloc(capacity + 1);
    while (text) {
        size += fread(text + size, 1, capacity - size, file);
        if (size < capacity) break;
        capacity *= 2;
        char *larger = capacity <= 2 * limit ? realloc(text, capacity + 1) : NULL;
        if (!larger) free(text);
        text = larger;
    }
    bool failed = ferror(file) != 0;
    fclose(file);
    if (text && !failed && size <= limit) {
        text[size] = 0;
        if (strlen(text) == size) return text;
        glint_fail(err, GLINT_ERROR_FORMAT, "%s: expected text, found a NUL byte at %zu", path, strlen(text));
    } else if (failed) glint_fail(err, GLINT_ERROR_IO, "%s: cannot be read", path);
    else glint_fail(err, GLINT_ERROR_LIMIT, "%s: expected at most %zu bytes of text", path, limit);
    free(text);
    return NULL;
}
