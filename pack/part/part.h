/* A part of the manifest while it is packed. */
#ifndef GLINT_PACK_PART_H
#define GLINT_PACK_PART_H

#include "glint/exr.h"
#include "roles.h"
#include "texture.h"

/* One channel of a part. */
struct channel {
    char name[256];
    struct node node;                /* what the manifest says of it */
    const struct texture *texture;   /* NULL: a constant */
    const struct source *sources[6]; /* in each of the texture's files */
    double value, scale, offset;
    bool is_scaled, is_integer, is_typed; /* is_typed: the manifest says `stored` */
    enum glint_stored stored;
    char storage[64];
    void *data;
};

struct part {
    struct textures *textures;
    const struct glint_frame *frame; /* NULL: a file of cube maps alone */
    uint32_t threads;
    struct node node, more; /* the part, and its `channels` */
    const char *name;
    const struct glint_role *role; /* NULL: unknown */
    bool is_previous, is_cube;
    struct channel *channels;
    size_t count;
    struct glint_encodings encodings;
    uint32_t width, height;
};

#endif
