/* NumPy arrays: the header of a .npy file, behind which the array lies as raw memory. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "readers.h"

struct header {
    char descr[16];
    bool fortran;
    uint64_t shape[4];
    size_t dimensions;
    size_t data; /* where the array begins */
};

/* What follows 'key': in the header's Python literal, which is ASCII text of at most `end`. */
static const char *value_of(const char *text, const char *key) {
    const char *at = strstr(text, key);
    if (!at) return NULL;
    at += strlen(key);
    return at + strspn(at, " :");
}

static bool parse_shape(const char *at, struct header *header) {
    if (!at || *at++ != '(') return false;
    for (;;) {
        at += strspn(at, " ,");
        if (*at == ')') return true;
        char *end;
        if (*at < '0' || *at > '9' || header->dimensions == 4) return false;
        header->shape[header->dimensions] = strtoull(at, &end, 10);
        if (header->shape[header->dimensions++] > UINT32_MAX) return false;
        at = end;
    }
}

static bool parse_header(const struct bytes *file, struct header *header) {
    if (file->size < 12 || memcmp(file->data, "\x93NUMPY", 6)) return false;
    const bool wide = file->data[6] >= 2;
    const uint64_t first = wide ? 12 : 10,
                   length = wide ? read_u32(file->data + 8) : (uint64_t)file->data[8] | (uint64_t)file->data[9] << 8;
    if (length > 65536 || first + length > file->size) return false;
    char *text = strndup((const char *)file->data + first, (size_t)length);
    if (!text) return false;
    const char *descr = value_of(text, "'descr'"), *order = value_of(text, "'fortran_order'");
    bool ok = descr && order && *descr == '\'' && parse_shape(value_of(text, "'shape'"), header);
    if (ok) snprintf(header->descr, sizeof header->descr, "%.*s", (int)strcspn(descr + 1, "'"), descr + 1);
    header->fortran = ok && !strncmp(order, "True", 4);
    header->data = (size_t)(first + length);
    free(text);
    return ok;
}

static bool kind_of(const char *descr, enum component_kind *kind, unsigned *bits) {
    const char *type = descr + strspn(descr, "<|=");
    char *end = NULL;
    const unsigned long bytes = *type ? strtoul(type + 1, &end, 10) : 0;
    if (*descr == '>' || !end || *end || (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8)) return false;
    *bits = 8 * (unsigned)bytes;
    *kind = *type == 'f' ? COMPONENT_FLOAT : *type == 'i' ? COMPONENT_SNORM : COMPONENT_UNORM;
    if (*type == 'b') *kind = COMPONENT_UINT; /* true is 1 */
    if (bytes == 4 && *type != 'f') *kind = *type == 'i' ? COMPONENT_SINT : COMPONENT_UINT;
    return strchr("fuib", *type) && (*type != 'f' || bytes > 1) && (*type == 'f' || bytes < 8);
}

bool image_read_npy(struct image *image, const struct node *texture, struct glint_error *err) {
    struct header header = {0};
    enum component_kind kind;
    unsigned bits;
    if (!parse_header(&image->bytes, &header))
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "expected a NumPy array's header, found another");
    if (!kind_of(header.descr, &kind, &bits))
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "expected little-endian floats of 2, 4 or 8 bytes or integers of 1, 2 or 4, found %s",
                         header.descr);
    if (header.fortran)
        return node_fail(texture, err, GLINT_ERROR_UNSUPPORTED,
                         "expected rows one after the other, found Fortran's order: save numpy.ascontiguousarray(a)");
    if (header.dimensions < 2 || header.dimensions > 3)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "expected an array of 2 or 3 dimensions (height, width, components), found %zu",
                         header.dimensions);
    const char *order = node_text(texture, "layout");
    const bool planar = order && !strcmp(order, "planar") && header.dimensions == 3;
    const uint64_t *shape = header.shape + (planar ? 1 : 0), components = header.dimensions == 2 ? 1
                                                                          : planar               ? header.shape[0]
                                                                                                 : header.shape[2];
    struct layout layout = {.width = (uint32_t)shape[1],
                            .height = (uint32_t)shape[0],
                            .layers = 1,
                            .planar = planar,
                            .offset = header.data};
    if (!image_format(texture, &layout.format, err)) return false;
    if (!layout.format && components >= 1 && components <= 4)
        layout.format = format_of_array(kind, bits, (unsigned)components);
    if (!layout.format)
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "expected 1 to 4 components, found %llu of %s",
                         (unsigned long long)components, header.descr);
    if (layout.format->bytes != components * bits / 8)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "format: expected %llu bytes a texel, as the file has, found %u",
                         (unsigned long long)components * bits / 8, layout.format->bytes);
    image->is_ambiguous = kind != COMPONENT_FLOAT && bits < 32 && !node_has(texture, "format");
    return image_lay_out(image, texture, &layout, err);
}
