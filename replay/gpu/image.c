/* Creation of images, their memory and their views. */
#include "image.h"

#include <stdio.h>
#include <stdlib.h>

VkImageSubresourceRange image_range(const struct image_desc *desc) {
    return (VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT, 0, desc->levels, 0, image_layers(desc)};
}

static bool create_buffer(struct image *image, struct gpu *gpu, struct glint_error *err) {
    const uint64_t texels = image_bytes(&image->desc, 0) / format_bytes(image->desc.format);
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(gpu->physical, &properties);
    if (texels > properties.limits.maxTexelBufferElements)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "image %s: %llu texels, but the device's limit is %u",
                          image->name, (unsigned long long)texels, properties.limits.maxTexelBufferElements);
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                     .size = image_bytes(&image->desc, 0),
                                     .usage = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                                              VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
                                              VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    if (!gpu_ok(gpu, vkCreateBuffer(gpu->device, &info, NULL, &image->buffer), image->name, err)) return false;
    device_set_name(gpu, VK_OBJECT_TYPE_BUFFER, (uint64_t)(uintptr_t)image->buffer, image->name);
    return true;
}

bool image_init(struct image *image, struct gpu *gpu, const char *name, const struct image_desc *desc,
                struct glint_error *err) {
    *image = (struct image){.desc = *desc};
    snprintf(image->name, sizeof image->name, "%s", name);
    if (desc->buffer) return create_buffer(image, gpu, err);
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
    VkResult result = vkGetPhysicalDeviceImageFormatProperties(gpu->physical, info.format, info.imageType, info.tiling,
                                                               info.usage, info.flags, &limits);
    if (result == VK_SUCCESS &&
        (info.extent.width > limits.maxExtent.width || info.extent.height > limits.maxExtent.height ||
         info.arrayLayers > limits.maxArrayLayers))
        glint_fail(err, GLINT_ERROR_UNSUPPORTED, "image %s: %u x %u x %u, but the device's limit is %u x %u x %u", name,
                   info.extent.width, info.extent.height, info.arrayLayers, limits.maxExtent.width,
                   limits.maxExtent.height, limits.maxArrayLayers);
    else if (result == VK_SUCCESS && (result = vkCreateImage(gpu->device, &info, NULL, &image->image)) == VK_SUCCESS) {
        device_set_name(gpu, VK_OBJECT_TYPE_IMAGE, (uint64_t)(uintptr_t)image->image, name);
        return true;
    } else gpu_fail(gpu, err, name, result);
    return false;
}

VkMemoryRequirements image_requirements(struct gpu *gpu, const struct image *image) {
    VkMemoryRequirements need;
    if (image->image) vkGetImageMemoryRequirements(gpu->device, image->image, &need);
    else vkGetBufferMemoryRequirements(gpu->device, image->buffer, &need);
    return need;
}

struct block *block_create(struct gpu *gpu, const VkMemoryRequirements *need, const char *name,
                           struct glint_error *err) {
    struct block *block = calloc(1, sizeof *block);
    if (!block) {
        glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", name);
        return NULL;
    }
    block->size = need->size;
    if (!device_allocate(gpu, need, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, name, &block->memory, err)) {
        free(block);
        return NULL;
    }
    return block;
}

static void block_release(struct block *block, const struct image *image, struct gpu *gpu) {
    if (block->owner == image) block->owner = NULL;
    if (--block->images > 0) return;
    GPU_DESTROY(gpu, vkFreeMemory, block->memory);
    free(block);
}

static bool create_view(const struct image *image, struct gpu *gpu, VkImageViewType type, uint32_t first,
                        uint32_t levels, VkImageView *view, struct glint_error *err) {
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = type,
        .format = format_vulkan(image->desc.format),
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, first, levels, 0,
                             type == VK_IMAGE_VIEW_TYPE_CUBE ? 6 : image_layers(&image->desc)}};
    if (!gpu_ok(gpu, vkCreateImageView(gpu->device, &info, NULL, view), image->name, err)) return false;
    device_set_name(gpu, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)(uintptr_t)*view, image->name);
    return true;
}

static bool bind_buffer(struct image *image, struct gpu *gpu, struct glint_error *err) {
    const VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                         .buffer = image->buffer,
                                         .format = format_vulkan(image->desc.format),
                                         .range = VK_WHOLE_SIZE};
    if (!gpu_ok(gpu, vkBindBufferMemory(gpu->device, image->buffer, image->block->memory, 0), image->name, err) ||
        !gpu_ok(gpu, vkCreateBufferView(gpu->device, &info, NULL, &image->buffer_view), image->name, err))
        return false;
    device_set_name(gpu, VK_OBJECT_TYPE_BUFFER_VIEW, (uint64_t)(uintptr_t)image->buffer_view, image->name);
    return true;
}

static bool bind_image(struct image *image, struct gpu *gpu, struct glint_error *err) {
    const bool layered = image->desc.layers != 0, cube = image->desc.cube;
    const VkImageViewType kind = layered ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    if (!gpu_ok(gpu, vkBindImageMemory(gpu->device, image->image, image->block->memory, 0), image->name, err))
        return false;
    for (uint32_t i = 0; i < image->desc.levels; i++)
        if (!create_view(image, gpu, kind, i, 1, &image->levels[i], err)) return false;
    return create_view(image, gpu, cube ? VK_IMAGE_VIEW_TYPE_CUBE : kind, 0, image->desc.levels, &image->view, err) &&
           (!cube ||
            create_view(image, gpu, VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, 0, image->desc.levels, &image->array_view, err)) &&
           (!layered || create_view(image, gpu, kind, 0, image->desc.levels, &image->faces_view, err));
}

bool image_bind(struct image *image, struct gpu *gpu, struct block *block, struct glint_error *err) {
    image->block = block;
    block->images++;
    image->bound = image->image ? bind_image(image, gpu, err) : bind_buffer(image, gpu, err);
    return image->bound;
}

bool image_own_memory(struct image *image, struct gpu *gpu, struct glint_error *err) {
    const VkMemoryRequirements need = image_requirements(gpu, image);
    struct block *block = block_create(gpu, &need, image->name, err);
    return block && image_bind(image, gpu, block, err);
}

void image_finish(struct image *image, struct gpu *gpu) {
    for (uint32_t i = 0; i < image->desc.levels; i++) GPU_DESTROY(gpu, vkDestroyImageView, image->levels[i]);
    GPU_DESTROY(gpu, vkDestroyImageView, image->view);
    GPU_DESTROY(gpu, vkDestroyImageView, image->array_view);
    GPU_DESTROY(gpu, vkDestroyImageView, image->faces_view);
    GPU_DESTROY(gpu, vkDestroyImage, image->image);
    GPU_DESTROY(gpu, vkDestroyBufferView, image->buffer_view);
    GPU_DESTROY(gpu, vkDestroyBuffer, image->buffer);
    if (image->block) block_release(image->block, image, gpu);
    *image = (struct image){0};
}
