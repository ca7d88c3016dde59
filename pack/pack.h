/* What the files of this library share while a manifest is packed. */
#ifndef GLINT_PACK_PACK_H
#define GLINT_PACK_PACK_H

#include "cube.h"
#include "glint/capture.h"
#include "glint/exr.h"
#include "glint/pack.h"
#include "image.h"
#include "manifest.h"

/* A texture, read when the first channel needs it; as a plain image, or as a cube map of N x 6N texels. */
struct texture {
    struct node node; /* a child of pack->textures */
    bool is_read, is_cube;
    struct image images[6];
    size_t image_count;
    struct cube cube;
    uint32_t width, height, layer;
    bool bottom_first, decode_srgb;
};

struct pack {
    struct manifest manifest;
    struct node root, textures_node, parts_node, frame_node;
    struct glint_pack_options options;
    struct texture *textures; /* two for each listed texture: plain, cube */
    size_t texture_count;
    bool has_frame;
    struct glint_frame frame;
};

/* Tells the caller what was understood. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void pack_note(const struct pack *pack, enum glint_pack_note kind, const struct node *node, const char *format, ...);

/* ---- Textures ---- */

bool textures_prepare(struct pack *pack, struct glint_error *err);
/* What was not said of them, in one line, and which were not used. */
void textures_note(const struct pack *pack);
void textures_finish(struct pack *pack);
/* The texture of this name, read; NULL on failure, which `user`, the node that names it, is the place of. */
struct texture *texture_find(struct pack *pack, const struct node *user, const char *name, size_t length, bool cube,
                             struct glint_error *err);
/* The length of the listed texture's name that `text` begins with, up to a dot or its end; 0 if there is none. */
size_t texture_name_length(const struct pack *pack, const char *text);

/* ---- Channels ---- */

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
    const struct pack *pack;
    struct node node, more; /* the part, and its `channels` */
    const char *name;
    const struct glint_role *role; /* NULL: unknown */
    bool is_previous, is_cube;
    struct channel *channels;
    size_t count;
    struct glint_encodings encodings;
    uint32_t width, height;
};

/* The role of a part's name, NULL if there is none. */
const struct glint_role *role_of(const char *part, bool *previous);
const struct glint_role_channel *role_channel(const struct glint_role *role, const char *name);

/* Reads the part's channels, and the textures that they name. */
bool channels_read(struct pack *pack, struct part *part, struct glint_error *err);
/* Chooses each channel's type and storage format; the encodings must be known. */
bool channels_choose(struct part *part, struct glint_error *err);
/* Allocates and fills each channel's data. */
bool channels_convert(struct part *part, struct glint_error *err);
void channels_finish(struct part *part);

/* Adds to the manifest what is in a multilayer EXR file of Blender: its texture, and channels that the manifest does not say. */
bool blender_add(struct pack *pack, const char *path, struct glint_error *err);

/* ---- Frame ---- */

/* The projection that a matrix describes, for a depth buffer in [0, 1]. */
struct projection {
    bool is_reversed, is_infinite;
    double near, far; /* units */
};
struct projection projection_of(const double view_to_clip[16], enum glint_clip_z clip_z);
enum glint_depth_encoding projection_encoding(const struct projection *projection);

/* Reads `frame`; width and height are those of the G-buffer. */
bool frame_read(struct pack *pack, uint32_t width, uint32_t height, struct glint_error *err);
/* How the frame's matrices are listed. */
struct matrix_order {
    bool is_transposed, is_column_major, is_row_vectors;
};
bool matrix_order_read(struct pack *pack, struct matrix_order *order, struct glint_error *err);
/* "world_to_view" or its inverse; *found: whether it was said. */
bool view_read(const struct node *node, const char *prefix, const struct matrix_order *order, double out[16],
               bool *found, struct glint_error *err);
bool camera_read(struct pack *pack, const struct node *node, const char *prefix, const struct matrix_order *order,
                 uint32_t width, uint32_t height, struct glint_camera *camera, struct glint_error *err);
bool planar_read(struct pack *pack, const struct node *part, struct glint_planar *planar, struct glint_error *err);
bool cubemap_read(const struct node *part, struct glint_cubemap *cubemap, struct glint_error *err);

/* ---- Parts ---- */

/* Chooses the encodings that the manifest leaves open, and checks the others against camera and textures. */
bool encodings_read(struct part *part, const struct glint_camera *camera, struct glint_error *err);

/* What of a part the writer does not take: attributes of other types than string, int and double, and parts without a role. */
struct extras;
struct extras *extras_create(void);
void extras_destroy(struct extras **extras);
bool extras_are_empty(const struct extras *extras);
/* Simple attributes of a known part go to *simple (malloc'd), all others to `extras`. */
bool attributes_read(const struct part *part, struct extras *extras, struct glint_attribute **simple, size_t *count,
                     struct glint_error *err);
/* Keeps a part without a role; takes over its channels' data. */
bool extras_add_part(struct extras *extras, struct part *part, struct glint_error *err);
/* Writes a copy of `from` with the extras to `to`. */
bool extras_write(const struct extras *extras, const char *from, const char *to, uint32_t threads,
                  struct glint_error *err);

#endif
