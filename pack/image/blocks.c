/* Compressed blocks (BC1 to BC7). Each image is decoded on its own by OpenImageIO, as a DDS file of one level, because its reader takes
   neither arrays nor most of DX10's format numbers. */
#include "blocks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oiio.h"

#define FOURCC(a, b, c, d) ((uint32_t)(a) | (uint32_t)(b) << 8 | (uint32_t)(c) << 16 | (uint32_t)(d) << 24)
#define DX10 FOURCC('D', 'X', '1', '0')

static const struct blocks rows[] = {
    {"BC1_RGB_UNORM", 131, 0, FOURCC('D', 'X', 'T', '1'), 0, 8, false, false},
    {"BC1_RGB_SRGB", 132, 0, FOURCC('D', 'X', 'T', '1'), 0, 8, true, false},
    {"BC1_RGBA_UNORM", 133, 71, FOURCC('D', 'X', 'T', '1'), 0, 8, false, false},
    {"BC1_RGBA_SRGB", 134, 72, FOURCC('D', 'X', 'T', '1'), 0, 8, true, false},
    {"BC2_UNORM", 135, 74, FOURCC('D', 'X', 'T', '3'), 0, 16, false, false},
    {"BC2_SRGB", 136, 75, FOURCC('D', 'X', 'T', '3'), 0, 16, true, false},
    {"BC3_UNORM", 137, 77, FOURCC('D', 'X', 'T', '5'), 0, 16, false, false},
    {"BC3_SRGB", 138, 78, FOURCC('D', 'X', 'T', '5'), 0, 16, true, false},
    {"BC4_UNORM", 139, 80, FOURCC('A', 'T', 'I', '1'), 0, 8, false, false},
    {"BC4_SNORM", 140, 81, FOURCC('A', 'T', 'I', '1'), 0, 8, false, true},
    {"BC5_UNORM", 141, 83, FOURCC('A', 'T', 'I', '2'), 0, 16, false, false},
    {"BC5_SNORM", 142, 84, FOURCC('A', 'T', 'I', '2'), 0, 16, false, true},
    {"BC6H_UFLOAT", 143, 95, DX10, 95, 16, false, false},
    {"BC6H_SFLOAT", 144, 96, DX10, 96, 16, false, false},
    {"BC7_UNORM", 145, 98, DX10, 98, 16, false, false},
    {"BC7_SRGB", 146, 99, DX10, 99, 16, true, false},
};
enum { ROWS = sizeof rows / sizeof *rows };

const struct blocks *blocks_by_vulkan(uint32_t number) {
    for (size_t i = 0; number && i < ROWS; i++)
        if (rows[i].vulkan_number == number) return &rows[i];
    return NULL;
}

const struct blocks *blocks_by_dxgi(uint32_t number) {
    for (size_t i = 0; number && i < ROWS; i++)
        if (rows[i].dxgi_number == number) return &rows[i];
    return NULL;
}

const struct blocks *blocks_by_fourcc(uint32_t fourcc) {
    if (fourcc == FOURCC('B', 'C', '4', 'U')) fourcc = FOURCC('A', 'T', 'I', '1');
    if (fourcc == FOURCC('B', 'C', '5', 'U')) fourcc = FOURCC('A', 'T', 'I', '2');
    if (fourcc == FOURCC('B', 'C', '4', 'S')) return blocks_by_dxgi(81);
    if (fourcc == FOURCC('B', 'C', '5', 'S')) return blocks_by_dxgi(84);
    for (size_t i = 0; i < ROWS; i++)
        if (rows[i].fourcc == fourcc && fourcc != DX10 && rows[i].dxgi_number) return &rows[i];
    return NULL;
}

static void put_u32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (uint8_t)(value >> (8 * i));
}

/* A DDS header for one image of blocks. Returns its length. */
static size_t write_header(uint8_t out[148], const struct blocks *blocks, const struct layout *layout) {
    memset(out, 0, 148);
    memcpy(out, "DDS ", 4);
    put_u32(out + 4, 124);
    put_u32(out + 8, 0x1007);
    put_u32(out + 12, layout->height);
    put_u32(out + 16, layout->width);
    put_u32(out + 76, 32);
    put_u32(out + 80, 4);
    put_u32(out + 84, blocks->fourcc);
    put_u32(out + 108, 0x1000);
    put_u32(out + 128, blocks->dx10);
    put_u32(out + 132, 3);
    put_u32(out + 140, 1);
    return blocks->dx10 ? 148 : 128;
}

/* OpenImageIO decodes unsigned BC4 and BC5. In a signed block only the two ends that each channel begins with mean something else, and what lies
   between them is interpolated alike: with 128 added to the ends it decodes to values that are 128 larger. The lowest code means -1, as the one
   above it does. */
static void make_unsigned(uint8_t *data, size_t bytes) {
    for (size_t at = 0; at < bytes; at += at % 8 == 0 ? 1 : 7) data[at] = (data[at] == 0x80 ? 0x81 : data[at]) ^ 0x80;
}

static void make_signed(uint8_t *values, size_t count) {
    for (size_t i = 0; i < count; i++) values[i] ^= 0x80;
}

static bool decode_one(const struct image *image, const struct node *texture, const struct blocks *blocks,
                       const struct layout *layout, size_t at, size_t bytes, struct oiio_image *out,
                       struct glint_error *err) {
    uint8_t *file = malloc(148 + bytes);
    if (!file) return node_no_memory(texture, err);
    const size_t header = write_header(file, blocks, layout);
    memcpy(file + header, image->bytes.data + at, bytes);
    if (blocks->is_signed) make_unsigned(file + header, bytes);
    bool ok =
        oiio_decode(blocks->name, "dds", file, header + bytes, IMAGE_MAX_BYTES, out, err) || node_wrap(texture, err);
    free(file);
    if (ok && blocks->is_signed) make_signed(out->pixels, out->size);
    if (ok && (out->width != layout->width || out->height != layout->height)) {
        free(out->pixels);
        ok = node_fail(texture, err, GLINT_ERROR_FORMAT, "%s: expected %u x %u texels, found %u x %u", blocks->name,
                       layout->width, layout->height, out->width, out->height);
    }
    return ok;
}

/* Makes room for all layers when the first one shows how large they are. */
static bool make_room(struct bytes *all, const struct oiio_image *first, const struct node *texture, uint32_t layers,
                      struct glint_error *err) {
    if ((uint64_t)first->size * layers > IMAGE_MAX_BYTES)
        return node_fail(texture, err, GLINT_ERROR_LIMIT, "expected at most 4 GiB of pixels, found %u layers of %zu",
                         layers, first->size);
    all->size = first->size * layers;
    all->data = malloc(all->size);
    return all->data != NULL || node_no_memory(texture, err);
}

static bool decode_all(const struct image *image, const struct node *texture, const struct blocks *blocks,
                       const struct layout *layout, struct bytes *all, struct oiio_image *last,
                       struct glint_error *err) {
    const uint64_t bytes = ((uint64_t)layout->width + 3) / 4 * (((uint64_t)layout->height + 3) / 4) * blocks->bytes,
                   pitch = layout->layer_pitch ? layout->layer_pitch : bytes;
    for (uint32_t i = 0; i < layout->layers; i++) {
        const uint64_t at = layout->offset + i * pitch;
        if (at + bytes > image->bytes.size)
            return node_fail(texture, err, GLINT_ERROR_FORMAT, "the file has %zu bytes; expected at least %llu",
                             image->bytes.size, (unsigned long long)(at + bytes));
        if (!decode_one(image, texture, blocks, layout, (size_t)at, (size_t)bytes, last, err)) return false;
        const bool fits =
            (i || make_room(all, last, texture, layout->layers, err)) && last->size * (i + 1) <= all->size;
        if (fits) memcpy(all->data + i * last->size, last->pixels, last->size);
        free(last->pixels);
        if (!fits) return all->data ? node_no_memory(texture, err) : false;
    }
    return true;
}

bool image_decode_blocks(struct image *image, const struct node *texture, const struct blocks *blocks,
                         const struct layout *layout, struct glint_error *err) {
    struct bytes all = {0};
    struct oiio_image last = {0};
    if (layout->width > IMAGE_MAX_WIDTH || layout->height > IMAGE_MAX_HEIGHT || layout->layers > IMAGE_MAX_LAYERS)
        return node_fail(texture, err, GLINT_ERROR_LIMIT, "expected a size within the limits, found %u x %u, %u layers",
                         layout->width, layout->height, layout->layers);
    if (!decode_all(image, texture, blocks, layout, &all, &last, err)) {
        free(all.data);
        return false;
    }
    struct layout flat = *layout;
    flat.offset = flat.row_pitch = flat.layer_pitch = 0;
    flat.format = format_of_array(last.is_float                        ? COMPONENT_FLOAT
                                  : blocks->is_signed                  ? COMPONENT_SNORM
                                  : blocks->srgb && last.channels >= 3 ? COMPONENT_SRGB
                                                                       : COMPONENT_UNORM,
                                  last.bits, last.channels);
    if (!flat.format && blocks->srgb) flat.format = format_by_name("VK_FORMAT_R8G8B8A8_SRGB");
    free(image->bytes.data);
    image->bytes = all;
    if (!flat.format || !image_lay_out(image, texture, &flat, err))
        return flat.format ? false
                           : node_fail(texture, err, GLINT_ERROR_UNSUPPORTED, "%s: cannot be read", blocks->name);
    snprintf(image->format, sizeof image->format, "%s", blocks->name);
    return true;
}
