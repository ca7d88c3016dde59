/* Copies between images and host memory, and fills. */
#include "state.h"

bool replay_staging(struct glint_replay *replay, VkDeviceSize size, struct glint_error *err) {
    if (replay->staging.size >= size) return true;
    host_buffer_finish(&replay->staging, replay->device);
    return host_buffer_init(&replay->staging, replay->device, HOST_BUFFER_UPLOAD, size, "staging", err);
}

static VkBufferImageCopy some_layers(const struct image *image, VkDeviceSize offset, uint32_t level, uint32_t first,
                                     uint32_t count) {
    return (VkBufferImageCopy){.bufferOffset = offset,
                               .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, first, count},
                               .imageExtent = image_extent(&image->desc, level)};
}

void image_record_upload(struct image *image, struct glint_device *device, const struct host_buffer *from,
                         VkDeviceSize offset, uint32_t level, uint32_t first_layer, uint32_t layers, bool discard) {
    struct barriers barriers = {0};
    if (discard) image->block->owner = NULL;
    image_access(image, IMAGE_COPY_WRITE, &barriers);
    barriers_record(&barriers, device);
    if (!image->image) {
        const VkBufferCopy all = {.srcOffset = offset, .size = image_bytes(&image->desc, 0)};
        vkCmdCopyBuffer(device->commands, from->buffer, image->buffer, 1, &all);
        return;
    }
    const VkBufferImageCopy copy = some_layers(image, offset, level, first_layer, layers);
    vkCmdCopyBufferToImage(device->commands, from->buffer, image->image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
}

void image_record_readback(struct image *image, struct glint_device *device, const struct host_buffer *to,
                           VkDeviceSize offset, uint32_t level) {
    struct barriers barriers = {0};
    image_access(image, IMAGE_COPY_READ, &barriers);
    barriers_record(&barriers, device);
    if (!image->image) {
        const VkBufferCopy all = {.dstOffset = offset, .size = image_bytes(&image->desc, 0)};
        vkCmdCopyBuffer(device->commands, image->buffer, to->buffer, 1, &all);
        return;
    }
    const VkBufferImageCopy copy = some_layers(image, offset, level, 0, image_layers(&image->desc));
    vkCmdCopyImageToBuffer(device->commands, image->image, VK_IMAGE_LAYOUT_GENERAL, to->buffer, 1, &copy);
}

void image_record_clear(struct image *image, struct glint_device *device, double value) {
    struct barriers barriers = {0};
    image->block->owner = NULL;
    image_access(image, IMAGE_CLEAR, &barriers);
    barriers_record(&barriers, device);
    if (!image->image) {
        vkCmdFillBuffer(device->commands, image->buffer, 0, VK_WHOLE_SIZE, (uint32_t)value);
        return;
    }
    VkClearColorValue color;
    for (int i = 0; i < 4; i++)
        if (format_is_uint(image->desc.format)) color.uint32[i] = (uint32_t)value;
        else color.float32[i] = (float)value;
    const VkImageSubresourceRange range = image_range(&image->desc);
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
