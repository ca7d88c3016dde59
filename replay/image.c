/* Creation of images, their memory and their views. */
#include "image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool image_desc_equal(const struct image_desc *a, const struct image_desc *b) {
    return a->format == b->format && a->width == b->width && a->height == b->height && a->layers == b->layers &&
           a->cube == b->cube && a->levels == b->levels && a->buffer == b->buffer;
}

const struct glint_image *image_shown(const struct image *image, uint32_t i) {
    if (image->as.row && i-- == 0) return &image->as;
    return image->listed && i < image->desc.levels ? &image->levels[i].info : NULL;
}

void image_hide(struct image *image) {
    image->listed = false;
    image->as.row = NULL;
}

uint32_t image_layers(const struct image_desc *desc) {
    return desc->layers ? desc->layers : 1;
}

VkExtent3D image_extent(const struct image_desc *desc, uint32_t level) {
    const uint32_t width = desc->width >> level, height = desc->height >> level;
    return (VkExtent3D){width ? width : 1, height ? height : 1, 1};
}

VkDeviceSize image_bytes(const struct image_desc *desc, uint32_t level) {
    const VkExtent3D extent = image_extent(desc, level);
    return (VkDeviceSize)extent.width * extent.height * image_layers(desc) * format_bytes(desc->format);
}

size_t image_values(const struct image_desc *desc, uint32_t level) {
    return (size_t)(image_bytes(desc, level) / format_bytes(desc->format)) * format_components(desc->format);
}

VkImageSubresourceRange image_range(const struct image_desc *desc) {
    return (VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT, 0, desc->levels, 0, image_layers(desc)};
}

uint32_t level_count(uint32_t width, uint32_t height) {
    uint32_t levels = 1;
    for (uint32_t size = width > height ? width : height; size > 1; size /= 2) levels++;
    return levels;
}

void image_rename(struct image *image, const char *name) {
    snprintf(image->name, sizeof image->name, "%s", name);
    for (uint32_t i = 1; i < image->desc.levels; i++)
        snprintf(image->levels[i].name, sizeof image->levels[i].name, "%s.level%u", image->name, i);
}

uint64_t image_memory_bytes(const struct image *image) {
    return image->block && !image->transient ? image->block->size : 0;
}

static void describe_levels(struct image *image) {
    const struct image_desc *desc = &image->desc;
    for (uint32_t i = 0; i < desc->levels; i++) {
        struct image_level *level = &image->levels[i];
        const VkExtent3D extent = image_extent(desc, i);
        level->info = (struct glint_image){.name = i ? level->name : image->name,
                                           .format = desc->format,
                                           .width = extent.width,
                                           .height = extent.height * image_layers(desc),
                                           .components = format_components(desc->format),
                                           .level = i,
                                           .levels = desc->levels};
    }
}

static VkResult create_buffer(struct image *image, struct glint_device *device, struct glint_error *err) {
    const uint64_t texels = image_bytes(&image->desc, 0) / format_bytes(image->desc.format);
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device->physical, &properties);
    if (texels > properties.limits.maxTexelBufferElements) {
        glint_fail(err, GLINT_ERROR_UNSUPPORTED, "image %s: %llu texels, but the device's limit is %u", image->name,
                   (unsigned long long)texels, properties.limits.maxTexelBufferElements);
        return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                     .size = image_bytes(&image->desc, 0),
                                     .usage = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                                              VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
                                              VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkResult result = vkCreateBuffer(device->device, &info, NULL, &image->buffer);
    if (result != VK_SUCCESS) vk_fail(err, image->name, result);
    else device_set_name(device, VK_OBJECT_TYPE_BUFFER, (uint64_t)(uintptr_t)image->buffer, image->name);
    return result;
}

struct image *image_create(struct glint_device *device, const char *name, const struct image_desc *desc,
                           struct glint_error *err) {
    struct image *image = calloc(1, sizeof *image);
    if (!image) {
        glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", name);
        return NULL;
    }
    image->desc = *desc;
    image_rename(image, name);
    describe_levels(image);
    if (desc->buffer) {
        if (create_buffer(image, device, err) == VK_SUCCESS) return image;
        free(image);
        return NULL;
    }
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .flags = desc->cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = format_vulkan(desc->format),
                                    .extent = {desc->width, desc->height, 1},
                                    .mipLevels = desc->levels,
                                    .arrayLayers = image_layers(desc),
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .tiling = VK_IMAGE_TILING_OPTIMAL,
                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                    .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
    VkImageFormatProperties limits = {0};
    VkResult result = vkGetPhysicalDeviceImageFormatProperties(device->physical, info.format, info.imageType,
                                                               info.tiling, info.usage, info.flags, &limits);
    if (result == VK_SUCCESS &&
        (info.extent.width > limits.maxExtent.width || info.extent.height > limits.maxExtent.height ||
         info.arrayLayers > limits.maxArrayLayers))
        glint_fail(err, GLINT_ERROR_UNSUPPORTED, "image %s: %u x %u x %u, but the device's limit is %u x %u x %u", name,
                   info.extent.width, info.extent.height, info.arrayLayers, limits.maxExtent.width,
                   limits.maxExtent.height, limits.maxArrayLayers);
    else if (result == VK_SUCCESS &&
             (result = vkCreateImage(device->device, &info, NULL, &image->image)) == VK_SUCCESS) {
        device_set_name(device, VK_OBJECT_TYPE_IMAGE, (uint64_t)(uintptr_t)image->image, name);
        return image;
    } else vk_fail(err, name, result);
    free(image);
    return NULL;
}

VkMemoryRequirements image_requirements(struct glint_device *device, const struct image *image) {
    VkMemoryRequirements need;
    if (image->image) vkGetImageMemoryRequirements(device->device, image->image, &need);
    else vkGetBufferMemoryRequirements(device->device, image->buffer, &need);
    return need;
}

struct block *block_create(struct glint_device *device, const VkMemoryRequirements *need, const char *name,
                           struct glint_error *err) {
    struct block *block = calloc(1, sizeof *block);
    if (!block) {
        glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", name);
        return NULL;
    }
    block->size = need->size;
    if (!device_allocate(device, need, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, name, &block->memory, err)) {
        free(block);
        return NULL;
    }
    return block;
}

static void block_release(struct block *block, const struct image *image, struct glint_device *device) {
    if (block->owner == image) block->owner = NULL;
    if (--block->images > 0) return;
    vkFreeMemory(device->device, block->memory, NULL);
    free(block);
}

static bool create_view(const struct image *image, struct glint_device *device, VkImageViewType type, uint32_t first,
                        uint32_t levels, VkImageView *view, struct glint_error *err) {
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = type,
        .format = format_vulkan(image->desc.format),
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, first, levels, 0,
                             type == VK_IMAGE_VIEW_TYPE_CUBE ? 6 : image_layers(&image->desc)}};
    VkResult result = vkCreateImageView(device->device, &info, NULL, view);
    if (result != VK_SUCCESS) return vk_fail(err, image->name, result);
    device_set_name(device, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)(uintptr_t)*view, image->name);
    return true;
}

static bool bind_buffer(struct image *image, struct glint_device *device, struct glint_error *err) {
    const VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                         .buffer = image->buffer,
                                         .format = format_vulkan(image->desc.format),
                                         .range = VK_WHOLE_SIZE};
    VkResult result = vkBindBufferMemory(device->device, image->buffer, image->block->memory, 0);
    if (result == VK_SUCCESS) result = vkCreateBufferView(device->device, &info, NULL, &image->buffer_view);
    if (result != VK_SUCCESS) return vk_fail(err, image->name, result);
    device_set_name(device, VK_OBJECT_TYPE_BUFFER_VIEW, (uint64_t)(uintptr_t)image->buffer_view, image->name);
    return true;
}

bool image_bind(struct image *image, struct glint_device *device, struct block *block, struct glint_error *err) {
    const bool layered = image->desc.layers != 0, cube = image->desc.cube;
    const VkImageViewType kind = layered ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    image->block = block;
    block->images++;
    if (!image->image) return bind_buffer(image, device, err);
    VkResult result = vkBindImageMemory(device->device, image->image, block->memory, 0);
    if (result != VK_SUCCESS) return vk_fail(err, image->name, result);
    for (uint32_t i = 0; i < image->desc.levels; i++)
        if (!create_view(image, device, kind, i, 1, &image->levels[i].view, err)) return false;
    return create_view(image, device, cube ? VK_IMAGE_VIEW_TYPE_CUBE : kind, 0, image->desc.levels, &image->view,
                       err) &&
           (!cube || create_view(image, device, VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, 0, image->desc.levels,
                                 &image->array_view, err)) &&
           (!layered || create_view(image, device, kind, 0, image->desc.levels, &image->faces_view, err));
}

bool image_own_memory(struct image *image, struct glint_device *device, struct glint_error *err) {
    const VkMemoryRequirements need = image_requirements(device, image);
    struct block *block = block_create(device, &need, image->name, err);
    return block && image_bind(image, device, block, err);
}

void image_destroy(struct image **pointer, struct glint_device *device) {
    struct image *image = *pointer;
    *pointer = NULL;
    if (!image) return;
    for (uint32_t i = 0; i < image->desc.levels; i++) vkDestroyImageView(device->device, image->levels[i].view, NULL);
    vkDestroyImageView(device->device, image->view, NULL);
    vkDestroyImageView(device->device, image->array_view, NULL);
    vkDestroyImageView(device->device, image->faces_view, NULL);
    vkDestroyImage(device->device, image->image, NULL);
    vkDestroyBufferView(device->device, image->buffer_view, NULL);
    vkDestroyBuffer(device->device, image->buffer, NULL);
    if (image->block) block_release(image->block, image, device);
    free(image);
}
