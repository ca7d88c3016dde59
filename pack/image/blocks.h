/* Compressed blocks (BC1 to BC7). */
#ifndef GLINT_PACK_BLOCKS_H
#define GLINT_PACK_BLOCKS_H

#include "image.h"

/* Formats of compressed blocks. */
struct blocks {
    const char *name;
    uint32_t vulkan_number, dxgi_number;
    uint32_t fourcc, dx10; /* what OpenImageIO's reader of DDS files takes */
    uint32_t bytes;        /* of a block of 4 x 4 texels */
    bool srgb;
    bool is_signed;
};
const struct blocks *blocks_by_vulkan(uint32_t number);
const struct blocks *blocks_by_dxgi(uint32_t number);
const struct blocks *blocks_by_fourcc(uint32_t fourcc);
/* Decodes images of one size whose blocks lie layout->layer_pitch bytes apart. */
bool image_decode_blocks(struct image *image, const struct node *texture, const struct blocks *blocks,
                         const struct layout *layout, struct glint_error *err);

#endif
