/* The textures that a manifest lists: which file, which way up, which layer. */
#ifndef GLINT_PACK_TEXTURE_H
#define GLINT_PACK_TEXTURE_H

#include "cube.h"
#include "image.h"

/* A texture, read when the first channel needs it; as a plain image, or as a cube map of N x 6N texels. */
struct texture {
    struct node node; /* a child of the manifest's textures */
    bool is_read, is_cube;
    struct glint_error fault; /* why it cannot be read: every channel that names it says the same */
    struct image images[6];
    size_t image_count;
    struct cube cube;
    uint32_t width, height, layer;
    bool bottom_first, decode_srgb;
};

struct textures {
    struct node node;
    struct texture *all; /* two for each listed texture: plain, cube */
    size_t count;
};

/* `root` is the whole manifest. */
bool textures_prepare(struct textures *textures, const struct node *root, struct glint_error *err);
/* What was not said of them, in one line, and which were not used. */
void textures_note(const struct textures *textures);
void textures_finish(struct textures *textures);
/* The texture of this name, read; NULL on failure, which `user`, the node that names it, is the place of. */
struct texture *texture_find(struct textures *textures, const struct node *user, const char *name, size_t length,
                             bool cube, struct glint_error *err);
/* The length of the listed texture's name that `text` begins with, up to a dot or its end; 0 if there is none. */
size_t texture_name_length(const struct textures *textures, const char *text);

#endif
