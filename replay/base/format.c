/* Image formats and descriptions, independent of a device. */
#include "format.h"

#include "glint/replay.h"

static const struct {
    uint32_t components;
    size_t bytes;
    const char *name;
    enum glint_format widened;
} formats[] = {
    [GLINT_FORMAT_R8UI] = {1, 1, "R8UI", GLINT_FORMAT_R8UI},
    [GLINT_FORMAT_R32UI] = {1, 4, "R32UI", GLINT_FORMAT_R32UI},
    [GLINT_FORMAT_R16F] = {1, 2, "R16F", GLINT_FORMAT_R32F},
    [GLINT_FORMAT_RG16F] = {2, 4, "RG16F", GLINT_FORMAT_RG32F},
    [GLINT_FORMAT_RGBA16F] = {4, 8, "RGBA16F", GLINT_FORMAT_RGBA32F},
    [GLINT_FORMAT_R32F] = {1, 4, "R32F", GLINT_FORMAT_R32F},
    [GLINT_FORMAT_RG32F] = {2, 8, "RG32F", GLINT_FORMAT_RG32F},
    [GLINT_FORMAT_RGBA32F] = {4, 16, "RGBA32F", GLINT_FORMAT_RGBA32F},
};

uint32_t format_components(enum glint_format format) {
    return formats[format].components;
}
size_t format_bytes(enum glint_format format) {
    return formats[format].bytes;
}
bool glint_format_is_uint(enum glint_format format) {
    return format == GLINT_FORMAT_R8UI || format == GLINT_FORMAT_R32UI;
}
const char *format_name(enum glint_format format) {
    return formats[format].name;
}
enum glint_format format_widened(enum glint_format format) {
    return formats[format].widened;
}

bool image_desc_equal(const struct image_desc *a, const struct image_desc *b) {
    return a->format == b->format && a->width == b->width && a->height == b->height && a->layers == b->layers &&
           a->cube == b->cube && a->levels == b->levels && a->buffer == b->buffer;
}

uint32_t image_layers(const struct image_desc *desc) {
    return desc->layers ? desc->layers : 1;
}

struct extent image_extent(const struct image_desc *desc, uint32_t level) {
    const uint32_t width = desc->width >> level, height = desc->height >> level;
    return (struct extent){width ? width : 1, height ? height : 1};
}

size_t image_bytes(const struct image_desc *desc, uint32_t level) {
    const struct extent extent = image_extent(desc, level);
    return (size_t)extent.width * extent.height * image_layers(desc) * format_bytes(desc->format);
}

size_t image_values(const struct image_desc *desc, uint32_t level) {
    return image_bytes(desc, level) / format_bytes(desc->format) * format_components(desc->format);
}

uint32_t level_count(uint32_t width, uint32_t height) {
    uint32_t levels = 1;
    for (uint32_t size = width > height ? width : height; size > 1; size /= 2) levels++;
    return levels;
}
