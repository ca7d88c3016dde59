/* Decoded channels of a part of the capture. */
#include "channels.h"

#include <stdlib.h>
#include <string.h>

size_t channels_find(const struct channels *channels, const char *name, size_t length) {
    size_t i = 0;
    while (i < channels->count &&
           (strncmp(channels->names[i], name, length) != 0 || strlen(channels->names[i]) != length))
        i++;
    return i;
}

bool channels_add(struct channels *channels, const char *name, size_t length, struct glint_error *err) {
    if (channels_find(channels, name, length) < channels->count) return true;
    const char **larger = realloc(channels->names, (channels->count + 1) * sizeof *larger);
    if (larger) channels->names = larger;
    char *copy = larger ? strndup(name, length) : NULL;
    if (!copy) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    channels->names[channels->count++] = copy;
    return true;
}

bool channels_add_row(struct channels *channels, const struct glint_row *row, struct glint_error *err) {
    for (const char *at = row->source; *at;) {
        const size_t length = strcspn(at, " ");
        if (!(length == 1 && *at == '-') && !channels_add(channels, at, length, err)) return false;
        at += length + (at[length] == ' ');
    }
    return true;
}

bool channels_read(struct channels *channels, struct glint_capture *capture, struct glint_error *err) {
    size_t values = (size_t)channels->part->width * channels->part->height * channels->count;
    channels->data = malloc(values * sizeof *channels->data);
    if (!channels->data)
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: part %s: no memory for %zu channels",
                          glint_capture_path(capture), channels->part->name, channels->count);
    return glint_capture_read(capture, channels->part, channels->names, channels->count, GLINT_F32, channels->data, 0,
                              err);
}

void channels_keep(struct channels *channels, size_t count) {
    while (channels->count > count) free((char *)channels->names[--channels->count]);
}

void channels_finish(struct channels *channels) {
    channels_keep(channels, 0);
    free(channels->names);
    free(channels->data);
    *channels = (struct channels){0};
}
