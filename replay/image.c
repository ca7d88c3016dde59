/* Creation of images and the barriers that follow from their use. */
#include "image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool image_desc_equal(const struct image_desc *a, const struct image_desc *b) {
    return a->format == b->format && a->width == b->width && a->height == b->height && a->layers == b->layers;
}

static uint32_t layer_count(const struct image_desc *desc) {
    return desc->layers ? desc->layers : 1;
}

VkDeviceSize image_bytes(const struct image_desc *desc) {
    return (VkDeviceSize)desc->width * desc->height * layer_count(desc) * format_bytes(desc->format);
}

struct image *image_create(struct glint_device *device, const char *name, const struct image_desc *desc,
                           struct glint_error *err) {
    struct image *image = calloc(1, sizeof *image);
    if (!image) {
        glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", name);
        return NULL;
    }
    snprintf(image->name, sizeof image->name, "%s", name);
    image->desc = *desc;
    image->info = (struct glint_image){.name = image->name,
                                       .format = desc->format,
                                       .width = desc->width,
                                       .height = desc->height * layer_count(desc),
                                       .components = format_components(desc->format)};
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .flags = desc->layers ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = format_vulkan(desc->format),
                                    .extent = {desc->width, desc->height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = layer_count(desc),
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
    vkGetImageMemoryRequirements(device->device, image->image, &need);
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

static bool create_view(const struct image *image, struct glint_device *device, VkImageViewType type, VkImageView *view,
                        struct glint_error *err) {
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = type,
        .format = format_vulkan(image->desc.format),
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0,
                             type == VK_IMAGE_VIEW_TYPE_CUBE ? 6 : layer_count(&image->desc)}};
    VkResult result = vkCreateImageView(device->device, &info, NULL, view);
    if (result != VK_SUCCESS) return vk_fail(err, image->name, result);
    device_set_name(device, VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)(uintptr_t)*view, image->name);
    return true;
}

bool image_bind(struct image *image, struct glint_device *device, struct block *block, struct glint_error *err) {
    image->block = block;
    block->images++;
    VkResult result = vkBindImageMemory(device->device, image->image, block->memory, 0);
    if (result != VK_SUCCESS) return vk_fail(err, image->name, result);
    if (!image->desc.layers) return create_view(image, device, VK_IMAGE_VIEW_TYPE_2D, &image->view, err);
    return create_view(image, device, VK_IMAGE_VIEW_TYPE_CUBE, &image->view, err) &&
           create_view(image, device, VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, &image->array_view, err);
}

void image_destroy(struct image **pointer, struct glint_device *device) {
    struct image *image = *pointer;
    *pointer = NULL;
    if (!image) return;
    vkDestroyImageView(device->device, image->view, NULL);
    vkDestroyImageView(device->device, image->array_view, NULL);
    vkDestroyImage(device->device, image->image, NULL);
    if (image->block) block_release(image->block, image, device);
    free(image);
}

static const struct {
    VkPipelineStageFlags2 stage;
    VkAccessFlags2 access;
    bool write;
} accesses[] = {
    [IMAGE_SHADER_READ] = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, false},
    [IMAGE_SHADER_WRITE] = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, true},
    [IMAGE_COPY_READ] = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, false},
    [IMAGE_COPY_WRITE] = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, true},
    [IMAGE_CLEAR] = {VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, true},
};

/* All images stay in the general layout: storage images must, and sampling from it costs nothing measurable here. */
void image_access(struct image *image, enum image_access access, struct barriers *barriers) {
    struct block *block = image->block;
    const VkPipelineStageFlags2 stage = accesses[access].stage;
    bool write = accesses[access].write, takes_over = block->owner != image;
    bool unseen_write = block->write_stage && !(block->read_stages & stage);
    bool after_others = block->write_stage || block->read_stages;
    if ((takes_over || (write ? after_others : unseen_write)) && barriers->count < PASS_IMAGES_MAX)
        barriers->images[barriers->count++] = (VkImageMemoryBarrier2){
            .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = write || takes_over ? block->write_stage | block->read_stages : block->write_stage,
            .srcAccessMask = block->write_access,
            .dstStageMask = stage,
            .dstAccessMask = accesses[access].access,
            .oldLayout = takes_over ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL,
            .newLayout = VK_IMAGE_LAYOUT_GENERAL,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = image->image,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layer_count(&image->desc)}};
    block->owner = image;
    if (write) {
        block->write_stage = stage;
        block->write_access = accesses[access].access;
        block->read_stages = 0;
    } else block->read_stages |= stage;
}

void barriers_record(struct barriers *barriers, struct glint_device *device) {
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .imageMemoryBarrierCount = barriers->count,
                                   .pImageMemoryBarriers = barriers->images};
    if (barriers->count) vkCmdPipelineBarrier2(device->commands, &info);
    barriers->count = 0;
}

static VkBufferImageCopy some_layers(const struct image *image, VkDeviceSize offset, uint32_t first, uint32_t count) {
    return (VkBufferImageCopy){.bufferOffset = offset,
                               .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, first, count},
                               .imageExtent = {image->desc.width, image->desc.height, 1}};
}

void image_record_upload(struct image *image, struct glint_device *device, const struct host_buffer *from,
                         VkDeviceSize offset, uint32_t first_layer, uint32_t layers, bool discard) {
    struct barriers barriers = {.count = 0};
    if (discard) image->block->owner = NULL;
    image_access(image, IMAGE_COPY_WRITE, &barriers);
    barriers_record(&barriers, device);
    const VkBufferImageCopy copy = some_layers(image, offset, first_layer, layers);
    vkCmdCopyBufferToImage(device->commands, from->buffer, image->image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
}

void image_record_readback(struct image *image, struct glint_device *device, const struct host_buffer *to,
                           VkDeviceSize offset) {
    struct barriers barriers = {.count = 0};
    image_access(image, IMAGE_COPY_READ, &barriers);
    barriers_record(&barriers, device);
    const VkBufferImageCopy copy = some_layers(image, offset, 0, layer_count(&image->desc));
    vkCmdCopyImageToBuffer(device->commands, image->image, VK_IMAGE_LAYOUT_GENERAL, to->buffer, 1, &copy);
}

void image_record_clear(struct image *image, struct glint_device *device, double value) {
    struct barriers barriers = {.count = 0};
    image->block->owner = NULL;
    image_access(image, IMAGE_CLEAR, &barriers);
    barriers_record(&barriers, device);
    VkClearColorValue color;
    for (int i = 0; i < 4; i++)
        if (format_is_uint(image->desc.format)) color.uint32[i] = (uint32_t)value;
        else color.float32[i] = (float)value;
    const VkImageSubresourceRange range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layer_count(&image->desc)};
    vkCmdClearColorImage(device->commands, image->image, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
}

void record_host_barrier(struct glint_device *device) {
    const VkMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                      .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                      .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(device->commands, &info);
}
