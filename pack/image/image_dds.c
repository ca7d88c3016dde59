/* DDS: the header of Direct3D's texture files, with or without DX10's; the texels behind it are raw memory or compressed blocks. */
#include <string.h>

#include "blocks.h"
#include "readers.h"

enum { FOURCC_DX10 = 0x30315844 };

struct header {
    const struct format *format;
    const struct blocks *blocks;
    uint32_t width, height, depth, mips, layers; /* layers: all faces of all elements */
    bool is_cube;
    size_t data;
};

/* The floating-point formats that have numbers in place of a FourCC. */
static uint32_t dxgi_of_fourcc(uint32_t fourcc) {
    static const uint32_t numbers[][2] = {{36, 11},  {110, 13}, {111, 54}, {112, 34},
                                          {113, 10}, {114, 41}, {115, 16}, {116, 2}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (numbers[i][0] == fourcc) return numbers[i][1];
    return 0;
}

/* The format whose components have these masks of red, green, blue, alpha. */
static const struct format *format_of_masks(const uint8_t *at) {
    const uint32_t flags = read_u32(at + 4), bits = read_u32(at + 12);
    uint32_t masks[4];
    for (int i = 0; i < 4; i++) masks[i] = read_u32(at + 16 + 4 * i);
    if (!(flags & 3)) masks[3] = 0;      /* alpha is not used */
    if (flags & 2) memset(masks, 0, 12); /* nothing but alpha */
    for (size_t i = 0; i < pack_format_count; i++) {
        const struct format *f = &pack_formats[i];
        bool same = f->bytes * 8 == bits;
        uint32_t found[4] = {0};
        for (unsigned c = 0; same && c < f->count; c++) {
            const char *letter = strchr("rgba", f->components[c].letter);
            same = letter && f->components[c].kind == COMPONENT_UNORM;
            if (same)
                found[letter - "rgba"] =
                    (uint32_t)(((UINT64_C(1) << f->components[c].bits) - 1) << f->components[c].first_bit);
        }
        if (same && !memcmp(found, masks, sizeof masks)) return f;
    }
    return NULL;
}

static void parse_dx10(const uint8_t *data, struct header *header) {
    const uint32_t number = read_u32(data + 128), arrays = read_u32(data + 140);
    header->format = format_by_dxgi(number);
    header->blocks = blocks_by_dxgi(number);
    header->is_cube = read_u32(data + 136) & 4;
    header->layers = arrays ? arrays : 1;
    header->data = 148;
}

static bool parse_header(const struct image *image, const struct node *texture, struct header *header,
                         struct glint_error *err) {
    const uint8_t *data = image->bytes.data;
    if (image->bytes.size < 128 || memcmp(data, "DDS ", 4) || read_u32(data + 4) != 124)
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "expected a DDS header, found another");
    const uint32_t fourcc = read_u32(data + 80) & 4 ? read_u32(data + 84) : 0, caps = read_u32(data + 112);
    *header = (struct header){.width = read_u32(data + 16),
                              .height = read_u32(data + 12),
                              .depth = caps & 0x200000 ? read_u32(data + 24) : 1,
                              .mips = read_u32(data + 28),
                              .layers = 1,
                              .is_cube = caps & 0x200,
                              .data = 128};
    if (fourcc == FOURCC_DX10 && image->bytes.size < 148)
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "the file ends within its header");
    if (fourcc == FOURCC_DX10) parse_dx10(data, header);
    else if (fourcc) {
        header->format = format_by_dxgi(dxgi_of_fourcc(fourcc));
        header->blocks = blocks_by_fourcc(fourcc);
    } else header->format = format_of_masks(data + 76);
    if (!header->mips) header->mips = 1;
    if (!header->depth) header->depth = 1;
    if (!header->format && !header->blocks)
        return node_fail(texture, err, GLINT_ERROR_UNSUPPORTED,
                         "expected a format of the table in docs/pack.md or BC1 to BC7, found %s %u: convert it first",
                         fourcc == FOURCC_DX10 ? "DXGI_FORMAT" : "FourCC",
                         fourcc == FOURCC_DX10 ? read_u32(data + 128) : fourcc);
    if (!header->width || !header->height || header->width > IMAGE_MAX_WIDTH || header->height > IMAGE_MAX_HEIGHT ||
        header->depth > IMAGE_MAX_LAYERS || header->layers > IMAGE_MAX_LAYERS || header->mips > 32)
        return node_fail(texture, err, GLINT_ERROR_LIMIT, "expected a size within the limits, found %u x %u x %u, %u",
                         header->width, header->height, header->depth, header->layers);
    if (header->is_cube) header->layers *= 6;
    return true;
}

static uint32_t halved(uint32_t size, uint32_t mip) {
    return size >> mip ? size >> mip : 1;
}

static uint64_t level_bytes(const struct header *h, uint32_t mip) {
    const uint64_t width = halved(h->width, mip), height = halved(h->height, mip), depth = halved(h->depth, mip);
    if (h->blocks) return (width + 3) / 4 * ((height + 3) / 4) * h->blocks->bytes * depth;
    return width * height * h->format->bytes * depth;
}

bool image_read_dds(struct image *image, const struct node *texture, struct glint_error *err) {
    struct header header = {0};
    const struct format *said;
    if (!parse_header(image, texture, &header, err) || !image_format(texture, &said, err)) return false;
    const uint64_t mip = node_count(texture, "mip", 0);
    const struct node mip_node = node_child(texture, "mip");
    if (mip >= header.mips)
        return node_fail(&mip_node, err, GLINT_ERROR_FORMAT, "expected a level below %u, as the file has, found %llu",
                         header.mips, (unsigned long long)mip);
    if (said && header.format && said->bytes != header.format->bytes)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "format: expected %u bytes a texel, as the file has, found %u", header.format->bytes,
                         said->bytes);
    uint64_t before = 0, chain = 0;
    for (uint32_t i = 0; i < header.mips; i++) {
        if (i < mip) before += level_bytes(&header, i);
        chain += level_bytes(&header, i);
    }
    const uint32_t depth = halved(header.depth, (uint32_t)mip);
    image->is_cube = header.is_cube;
    const struct layout layout = {.format = said ? said : header.format,
                                  .width = halved(header.width, (uint32_t)mip),
                                  .height = halved(header.height, (uint32_t)mip),
                                  .layers = depth > 1 ? depth : header.layers,
                                  .offset = header.data + before,
                                  .layer_pitch = depth > 1 ? level_bytes(&header, (uint32_t)mip) / depth : chain};
    return header.blocks ? image_decode_blocks(image, texture, header.blocks, &layout, err)
                         : image_lay_out(image, texture, &layout, err);
}
