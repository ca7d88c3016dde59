/* Reads images of raw memory, and chooses the reader for files that describe themselves. */
#include "read.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "oiio.h"
#include "readers.h"

static bool read_raw(struct image *image, const struct node *texture, bool cube, struct glint_error *err) {
    const char *layout_name = node_text(texture, "layout");
    struct layout layout = {.width = (uint32_t)node_count(texture, "width", 0),
                            .height = (uint32_t)node_count(texture, "height", 0),
                            .planar = layout_name && !strcmp(layout_name, "planar"),
                            .offset = node_count(texture, "offset", 0),
                            .row_pitch = node_count(texture, "row_pitch", 0),
                            .layer_pitch = node_count(texture, "layer_pitch", 0)};
    if (!image_format(texture, &layout.format, err)) return false;
    if (!layout.format || !node_has(texture, "width") || !node_has(texture, "height"))
        return node_fail(texture, err, GLINT_ERROR_FORMAT, "raw memory: expected format, width and height, found no %s",
                         !layout.format               ? "format"
                         : node_has(texture, "width") ? "height"
                                                      : "width");
    if (node_count(texture, "mip", 0))
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "mip: raw memory holds one level: give its offset, width and height");
    const uint64_t layers = node_count(texture, "layer", 0) + node_count(texture, "slice", 0) + 1;
    const struct node arranged = node_child(texture, "cube");
    const char *faces = arranged.value ? node_text(&arranged, "layout") : NULL;
    const bool six =
        faces ? !strcmp(faces, "layers") : cube && layout.width == layout.height && !node_has(texture, "files");
    image->is_cube = six;
    layout.layers = layers < IMAGE_MAX_LAYERS ? (uint32_t)layers * (six ? 6 : 1) : UINT32_MAX;
    return image_lay_out(image, texture, &layout, err);
}

/* These files are compressed well enough that a small one unpacks to anything. */
#define OIIO_MAX_BYTES (UINT64_C(1) << 30)

static bool read_oiio(struct image *image, const struct node *texture, const char *path, const char *kind,
                      struct glint_error *err) {
    struct oiio_image decoded = {0};
    if (!oiio_decode(path, kind, image->bytes.data, image->bytes.size, OIIO_MAX_BYTES, &decoded, err))
        return node_wrap(texture, err);
    const struct format *format;
    free(image->bytes.data);
    image->bytes = (struct bytes){.data = decoded.pixels, .size = decoded.size};
    if (!image_format(texture, &format, err)) return false;
    if (!format)
        format = format_of_array(decoded.is_float ? COMPONENT_FLOAT : COMPONENT_UNORM, decoded.bits, decoded.channels);
    if (!format || format->bytes != decoded.channels * decoded.bits / 8)
        return node_fail(texture, err, GLINT_ERROR_FORMAT,
                         "format: expected %u bytes a texel, as the file has, found %u",
                         decoded.channels * decoded.bits / 8, format ? format->bytes : 0);
    image->is_ambiguous = !decoded.is_float && !node_has(texture, "format");
    const struct layout layout = {.format = format, .width = decoded.width, .height = decoded.height, .layers = 1};
    return image_lay_out(image, texture, &layout, err);
}

static bool ends_with(const char *path, const char *suffix) {
    const size_t length = strlen(path), tail = strlen(suffix);
    return length > tail && !strcasecmp(path + length - tail, suffix);
}

bool image_read(struct image *image, const struct node *texture, const char *path, bool cube, struct glint_error *err) {
    *image = (struct image){0};
    const char *passes = node_text(texture, "passes");
    if (passes && !strcmp(passes, "blender")) return image_read_blender(image, texture, path, err);
    if (ends_with(path, ".exr")) return image_read_exr(image, texture, path, err);
    if (!file_read(path, IMAGE_MAX_BYTES, &image->bytes, err)) return node_wrap(texture, err);
    if (ends_with(path, ".png")) return read_oiio(image, texture, path, "png", err);
    if (ends_with(path, ".hdr")) return read_oiio(image, texture, path, "hdr", err);
    if (ends_with(path, ".npy")) return image_read_npy(image, texture, err);
    if (ends_with(path, ".ktx2")) return image_read_ktx2(image, texture, err);
    if (ends_with(path, ".dds")) return image_read_dds(image, texture, err);
    return read_raw(image, texture, cube, err);
}
