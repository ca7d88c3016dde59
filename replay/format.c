/* Image formats: what each is in Vulkan and in memory. */
#include "device.h"

static const struct {
    VkFormat vulkan;
    uint32_t components;
    size_t bytes;
    const char *name;
    enum glint_format widened;
} formats[] = {
    [GLINT_FORMAT_R8UI] = {VK_FORMAT_R8_UINT, 1, 1, "R8UI", GLINT_FORMAT_R8UI},
    [GLINT_FORMAT_R32UI] = {VK_FORMAT_R32_UINT, 1, 4, "R32UI", GLINT_FORMAT_R32UI},
    [GLINT_FORMAT_R16F] = {VK_FORMAT_R16_SFLOAT, 1, 2, "R16F", GLINT_FORMAT_R32F},
    [GLINT_FORMAT_RG16F] = {VK_FORMAT_R16G16_SFLOAT, 2, 4, "RG16F", GLINT_FORMAT_RG32F},
    [GLINT_FORMAT_RGBA16F] = {VK_FORMAT_R16G16B16A16_SFLOAT, 4, 8, "RGBA16F", GLINT_FORMAT_RGBA32F},
    [GLINT_FORMAT_R32F] = {VK_FORMAT_R32_SFLOAT, 1, 4, "R32F", GLINT_FORMAT_R32F},
    [GLINT_FORMAT_RG32F] = {VK_FORMAT_R32G32_SFLOAT, 2, 8, "RG32F", GLINT_FORMAT_RG32F},
    [GLINT_FORMAT_RGBA32F] = {VK_FORMAT_R32G32B32A32_SFLOAT, 4, 16, "RGBA32F", GLINT_FORMAT_RGBA32F},
};

VkFormat format_vulkan(enum glint_format format) {
    return formats[format].vulkan;
}
uint32_t format_components(enum glint_format format) {
    return formats[format].components;
}
size_t format_bytes(enum glint_format format) {
    return formats[format].bytes;
}
bool format_is_uint(enum glint_format format) {
    return format == GLINT_FORMAT_R8UI || format == GLINT_FORMAT_R32UI;
}
const char *format_name(enum glint_format format) {
    return formats[format].name;
}
enum glint_format format_widened(enum glint_format format) {
    return formats[format].widened;
}
