/* An image file in memory, as components that can be read texel by texel. */
#ifndef GLINT_PACK_IMAGE_H
#define GLINT_PACK_IMAGE_H

#include "file.h"
#include "format.h"
#include "manifest.h"

/* Limits of one texture. */
#define IMAGE_MAX_BYTES (UINT64_C(4) << 30)
enum { IMAGE_MAX_WIDTH = 32768, IMAGE_MAX_HEIGHT = 6 * 32768, IMAGE_MAX_LAYERS = 6 * 4096 };

/* One component: the texel (x, y) of a layer begins at first + layer · layer_pitch + y · row_pitch + x · x_step. */
struct source {
    char *name; /* "r", or the channel's name of an EXR file */
    struct component component;
    size_t first, x_step, row_pitch, layer_pitch;
};

struct image {
    uint32_t width, height, layers;
    bool is_cube;      /* the layers are faces, six a cube map */
    bool is_ambiguous; /* integers that stand for [0, 1] or for themselves, as the channel wants them */
    struct source *sources;
    size_t count;
    char format[64]; /* for messages: "VK_FORMAT_R8_UNORM", "half" */
    struct bytes bytes;
};

/* What a manifest says of a texture, and what was found in the container of a file: where the texels lie in image->bytes. */
struct layout {
    const struct format *format;
    uint32_t width, height, layers;
    bool planar;
    uint64_t offset, row_pitch, layer_pitch; /* pitches 0: tight */
};

/* Reads the file as the texture's node says; `cube`: it is wanted as a cube map, and no single face. Errors name the node. */
bool image_read(struct image *image, const struct node *texture, const char *path, bool cube, struct glint_error *err);
void image_finish(struct image *image);
/* The source of this name: its whole name, or a letter, with x y z w for r g b a. NULL if there is none. */
const struct source *image_source(const struct image *image, const char *name, size_t length);

/* ---- for the readers of the kinds of files ---- */

/* Lays components over image->bytes, whose size is checked. */
bool image_lay_out(struct image *image, const struct node *texture, const struct layout *layout,
                   struct glint_error *err);
/* The format that the node names, NULL if it names none; an unknown one is an error. */
bool image_format(const struct node *texture, const struct format **format, struct glint_error *err);
bool image_no_memory(const struct node *texture, struct glint_error *err);

bool image_read_exr(struct image *image, const struct node *texture, const char *path, struct glint_error *err);
bool image_read_blender(struct image *image, const struct node *texture, const char *path, struct glint_error *err);
bool image_read_npy(struct image *image, const struct node *texture, struct glint_error *err);
bool image_read_ktx2(struct image *image, const struct node *texture, struct glint_error *err);
bool image_read_dds(struct image *image, const struct node *texture, struct glint_error *err);

/* Formats of compressed blocks. */
struct blocks {
    const char *name;
    uint32_t vulkan_number, dxgi_number;
    uint32_t fourcc, dx10; /* what OpenImageIO's reader of DDS files takes */
    uint32_t bytes;        /* of a block of 4 x 4 texels */
    bool srgb;
};
const struct blocks *blocks_by_vulkan(uint32_t number);
const struct blocks *blocks_by_dxgi(uint32_t number);
const struct blocks *blocks_by_fourcc(uint32_t fourcc);
/* Decodes images of one size whose blocks lie layout->layer_pitch bytes apart. */
bool image_decode_blocks(struct image *image, const struct node *texture, const struct blocks *blocks,
                         const struct layout *layout, struct glint_error *err);

/* Little-endian numbers of a header. */
uint32_t read_u32(const uint8_t *at);
uint64_t read_u64(const uint8_t *at);

#endif
