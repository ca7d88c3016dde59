/* Finds presets: files by path, $GLINT_PRESETS, and those built into the library. */
#include "pipeline.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "faults.h"

struct builtin_preset {
    const char *name, *text;
};
#include "builtin_presets.h"
enum { BUILTIN = sizeof builtin_presets / sizeof builtin_presets[0] };

const char *glint_preset(size_t i) {
    return i < BUILTIN ? builtin_presets[i].name : NULL;
}

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

static char *copy(const char *text, struct glint_error *err) {
    char *result = strdup(text);
    if (!result) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    return result;
}

char *preset_text(const char *preset, char **where, struct glint_error *err) {
    enum { LIMIT = 1 << 20 };
    char path[4096];
    size_t length = strlen(preset);
    *where = NULL;
    if (strchr(preset, '/') || (length > 5 && strcmp(preset + length - 5, ".json") == 0)) {
        if (!(*where = copy(preset, err))) return NULL;
        return file_text(preset, LIMIT, err);
    }
    const char *folder = getenv("GLINT_PRESETS");
    if (folder && folder[0] && snprintf(path, sizeof path, "%s/%s.json", folder, preset) < (int)sizeof path) {
        FILE *file = fopen(path, "rb");
        if (file) {
            fclose(file);
            if (!(*where = copy(path, err))) return NULL;
            return file_text(path, LIMIT, err);
        }
    }
    char known[512] = "";
    for (size_t i = 0; i < BUILTIN; i++) {
        if (strcmp(builtin_presets[i].name, preset) == 0) {
            if (!(*where = copy(preset, err))) return NULL;
            return copy(builtin_presets[i].text, err);
        }
        text_list(known, sizeof known, builtin_presets[i].name);
    }
    glint_fail(err, GLINT_ERROR_USAGE, "unknown preset '%s'; built in: %s; others by path or in $GLINT_PRESETS", preset,
               known);
    return NULL;
}
