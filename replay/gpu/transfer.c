/* Copies between images and host memory, and clears. */
#include "image.h"

static VkBufferImageCopy layer_copy(const struct image *image, VkDeviceSize offset, uint32_t level, uint32_t first,
                                    uint32_t count) {
    const struct extent extent = image_extent(&image->desc, level);
    return (VkBufferImageCopy){.bufferOffset = offset,
                               .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, first, count},
                               .imageExtent = {extent.width, extent.height, 1}};
}

void image_record_upload(struct image *image, struct gpu *gpu, const struct host_buffer *from, VkDeviceSize offset,
                         uint32_t level, uint32_t first_layer, uint32_t layers, bool discard) {
    struct barriers barriers = {0};
    if (discard) image->block->owner = NULL;
    image_access(image, IMAGE_COPY_WRITE, &barriers);
    barriers_record(&barriers, gpu);
    if (!image->image) {
        const VkBufferCopy all = {.srcOffset = offset, .size = image_bytes(&image->desc, 0)};
        vkCmdCopyBuffer(gpu->commands, from->buffer, image->buffer, 1, &all);
        return;
    }
    const VkBufferImageCopy copy = layer_copy(image, offset, level, first_layer, layers);
    vkCmdCopyBufferToImage(gpu->commands, from->buffer, image->image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
}

void image_record_readback(struct image *image, struct gpu *gpu, const struct host_buffer *to, VkDeviceSize offset,
                           uint32_t level) {
    struct barriers barriers = {0};
    image_access(image, IMAGE_COPY_READ, &barriers);
    barriers_record(&barriers, gpu);
    if (!image->image) {
        const VkBufferCopy all = {.dstOffset = offset, .size = image_bytes(&image->desc, 0)};
        vkCmdCopyBuffer(gpu->commands, image->buffer, to->buffer, 1, &all);
        return;
    }
    const VkBufferImageCopy copy = layer_copy(image, offset, level, 0, image_layers(&image->desc));
    vkCmdCopyImageToBuffer(gpu->commands, image->image, VK_IMAGE_LAYOUT_GENERAL, to->buffer, 1, &copy);
}

void image_record_clear(struct image *image, struct gpu *gpu, double value) {
    struct barriers barriers = {0};
    image->block->owner = NULL;
    image_access(image, IMAGE_CLEAR, &barriers);
    barriers_record(&barriers, gpu);
    if (!image->image) {
        vkCmdFillBuffer(gpu->commands, image->buffer, 0, VK_WHOLE_SIZE, (uint32_t)value);
        return;
    }
    VkClearColorValue color;
    for (int i = 0; i < 4; i++)
        if (glint_format_is_uint(image->desc.format)) color.uint32[i] = (uint32_t)value;
        else color.float32[i] = (float)value;
    const VkImageSubresourceRange range = image_range(&image->desc);
    vkCmdClearColorImage(gpu->commands, image->image, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
}

void record_host_barrier(struct gpu *gpu) {
    const VkMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                      .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                      .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(gpu->commands, &info);
}
