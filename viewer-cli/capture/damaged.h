/* What can be read of a damaged EXR file, which the EXR library opens whole or not at all: its headers up to where they break, and how many
   of each part's chunks are in the file. No pixel is decoded. */
#ifndef GLINT_VIEWER_DAMAGED_H
#define GLINT_VIEWER_DAMAGED_H

#include <stdint.h>

#include <jansson.h>

#include "glint/common.h"

enum { DAMAGED_CHANNELS = 64 };
struct damaged_part {
    char name[256]; /* "" if the header has none */
    int64_t width, height;
    struct damaged_channel {
        char name[256];
        uint32_t type; /* 0 uint, 1 half, 2 float */
    } channels[DAMAGED_CHANNELS];
    size_t channel_count, attribute_count;
    int64_t chunks, whole; /* whole: those that lie in the file completely */
    int64_t bytes;         /* of its header */
    bool multi_part, complete;
};
struct damaged {
    struct damaged_part *parts;
    size_t count;
    char fault[600]; /* where the headers or the first chunk break; "" if nothing was found */
};
/* False if the file cannot be read or does not begin as an EXR file. */
bool damaged_read(struct damaged *damaged, const char *path, struct glint_error *err);
void damaged_finish(struct damaged *damaged);
void damaged_print(const struct damaged *damaged);
json_t *damaged_json(const struct damaged *damaged);

#endif
