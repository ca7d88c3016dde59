/* KTX2: the header and the level index; the level's bytes are raw memory, perhaps compressed by zstd. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <zstd.h>

#include "blocks.h"
#include "readers.h"

struct level {
    uint64_t offset, length, unpacked;
};

static bool read_level(const struct image *image, const struct node *texture, uint32_t levels, struct level *out,
                       struct glint_error *err) {
    const uint64_t mip = node_count(texture, "mip", 0);
    const struct node node = node_child(texture, "mip");
    if (mip >= levels)
        return node_fail(&node, err, GLINT_ERROR_FORMAT, "expected a level below %u, as the file has, found %llu",
                         levels, (unsigned long long)mip);
    if (80 + 24 * (mip + 1) > image->bytes.size)
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "the file ends within its level index");
    const uint8_t *at = image->bytes.data + 80 + 24 * mip;
    *out = (struct level){read_u64(at), read_u64(at + 8), read_u64(at + 16)};
    if (out->offset > image->bytes.size || out->length > image->bytes.size - out->offset)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "level %llu: the file has %zu bytes; expected %llu from %llu on", (unsigned long long)mip,
                         image->bytes.size, (unsigned long long)out->length, (unsigned long long)out->offset);
    return true;
}

/* The bytes of the texels of a level, or of its blocks. */
static double bytes_of(const struct layout *layout, const struct blocks *blocks) {
    const double texels = (double)layout->width * layout->height * layout->layers,
                 count = blocks ? ceil(layout->width / 4.) * ceil(layout->height / 4.) * layout->layers : texels;
    return count * (blocks ? blocks->bytes : layout->format->bytes);
}

/* Replaces the file's bytes by the level's, which are `most` at most: a small file can say that it unpacks to gigabytes. A block of zstd has at
   least 4 bytes, and unpacks to at most 128 KiB. */
static bool unpack(struct image *image, const struct node *texture, const struct level *level, double most,
                   struct glint_error *err) {
    enum { BLOCK_BYTES = 1 << 17, LEAST_BYTES = 4 };
    if ((double)level->unpacked > most)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "zstd: expected at most the %.0f bytes of the level's texels, found %llu", most,
                         (unsigned long long)level->unpacked);
    if (level->unpacked > IMAGE_MAX_BYTES)
        return node_fail(texture, err, GLINT_ERROR_LIMIT, "expected at most 4 GiB of pixels, found %llu bytes",
                         (unsigned long long)level->unpacked);
    if (level->unpacked / BLOCK_BYTES > level->length / LEAST_BYTES)
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "zstd: expected %llu bytes, and %llu cannot hold as many",
                         (unsigned long long)level->unpacked, (unsigned long long)level->length);
    uint8_t *data = malloc((size_t)level->unpacked + 1);
    if (!data) return node_no_memory(texture, err);
    const size_t done =
        ZSTD_decompress(data, (size_t)level->unpacked, image->bytes.data + level->offset, (size_t)level->length);
    if (ZSTD_isError(done) || done != level->unpacked) {
        free(data);
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "zstd: expected %llu bytes: %s",
                         (unsigned long long)level->unpacked,
                         ZSTD_isError(done) ? ZSTD_getErrorName(done) : "found fewer");
    }
    free(image->bytes.data);
    image->bytes = (struct bytes){.data = data, .size = done};
    return true;
}

static uint32_t halved(uint32_t size, uint64_t mip) {
    const uint32_t smaller = mip < 32 ? size >> mip : 0;
    return smaller ? smaller : 1;
}

static bool choose_format(const struct image *image, const struct node *texture, struct layout *layout,
                          struct glint_error *err) {
    const uint32_t number = read_u32(image->bytes.data + 12);
    const struct format *own = format_by_vulkan(number);
    if (!image_format(texture, &layout->format, err)) return false;
    if (!layout->format) layout->format = own;
    if (!layout->format && !blocks_by_vulkan(number))
        return node_fail(texture, err, GLINT_ERROR_UNSUPPORTED,
                         "expected a format of the table in docs/pack.md, found VkFormat %u: convert the texture to an "
                         "uncompressed format first",
                         number);
    if (own && layout->format->bytes != own->bytes)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "format: expected %u bytes a texel, as the file has, found %u", own->bytes,
                         layout->format->bytes);
    return true;
}

bool image_read_ktx2(struct image *image, const struct node *texture, struct glint_error *err) {
    static const uint8_t magic[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
    const uint8_t *data = image->bytes.data;
    if (image->bytes.size < 80 || memcmp(data, magic, sizeof magic))
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "expected a KTX2 header, found another");
    const uint32_t width = read_u32(data + 20), height = read_u32(data + 24), depth = read_u32(data + 28),
                   arrays = read_u32(data + 32), faces = read_u32(data + 36), levels = read_u32(data + 40),
                   scheme = read_u32(data + 44), number = read_u32(data + 12);
    const uint64_t mip = node_count(texture, "mip", 0);
    struct layout layout = {.width = halved(width, mip), .height = halved(height ? height : 1, mip)};
    struct level level = {0};
    if (scheme != 0 && scheme != 2)
        return node_fail(texture, err, GLINT_ERROR_UNSUPPORTED,
                         "expected no supercompression or zstd, found scheme %u%s", scheme,
                         scheme == 1 ? " (Basis): transcode the texture first" : "");
    if (!width || (faces != 1 && faces != 6) || arrays > IMAGE_MAX_LAYERS || depth > IMAGE_MAX_LAYERS)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "expected a width, 1 or 6 faces and few layers, found %u, %u and %u", width, faces, arrays);
    if (!choose_format(image, texture, &layout, err) || !read_level(image, texture, levels ? levels : 1, &level, err))
        return false;
    const uint64_t layers = (uint64_t)(arrays ? arrays : 1) * faces * halved(depth ? depth : 1, mip);
    layout.layers = layers > IMAGE_MAX_LAYERS ? UINT32_MAX : (uint32_t)layers;
    layout.offset = scheme ? 0 : level.offset;
    image->is_cube = faces == 6;
    const struct blocks *blocks = layout.format ? NULL : blocks_by_vulkan(number);
    if (scheme && !unpack(image, texture, &level, bytes_of(&layout, blocks), err)) return false;
    return blocks ? image_decode_blocks(image, texture, blocks, &layout, err)
                  : image_lay_out(image, texture, &layout, err);
}
