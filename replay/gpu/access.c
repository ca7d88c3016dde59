/* Derives barriers from how images are accessed. */
#include "image.h"

static const struct {
    VkPipelineStageFlags2 stage;
    VkAccessFlags2 access;
    bool write;
} accesses[] = {
    [IMAGE_SHADER_READ] = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, false},
    [IMAGE_SHADER_WRITE] = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, true},
    [IMAGE_SHADER_BOTH] = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                           VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, true},
    [IMAGE_SHADER_STORAGE] = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, true},
    [IMAGE_COPY_READ] = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, false},
    [IMAGE_COPY_WRITE] = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, true},
    [IMAGE_CLEAR] = {VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, true},
    [IMAGE_GROUPS] = {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, false},
};

/* All images stay in the general layout, which storage images need and in which sampling is not measurably slower. So only an image that
   takes over memory of another one needs an image barrier, which sets its layout. */
void image_access(struct image *image, enum image_access access, struct barriers *barriers) {
    struct block *block = image->block;
    const VkPipelineStageFlags2 stage = accesses[access].stage;
    const bool write = accesses[access].write, takes_over = block->owner != image;
    const bool pending_write = block->write_stage && !(block->read_stages & stage);
    const bool after_others = block->write_stage || block->read_stages;
    const VkPipelineStageFlags2 from =
        write || takes_over ? block->write_stage | block->read_stages : block->write_stage;
    VkMemoryBarrier2 *memory = &barriers->memory;
    if (takes_over && image->image && barriers->count < BARRIERS_MAX)
        barriers->images[barriers->count++] = (VkImageMemoryBarrier2){.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                                                      .srcStageMask = from,
                                                                      .srcAccessMask = block->write_access,
                                                                      .dstStageMask = stage,
                                                                      .dstAccessMask = accesses[access].access,
                                                                      .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                                                      .newLayout = VK_IMAGE_LAYOUT_GENERAL,
                                                                      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                                                      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                                                      .image = image->image,
                                                                      .subresourceRange = image_range(&image->desc)};
    else if (takes_over || write ? after_others : pending_write)
        *memory = (VkMemoryBarrier2){.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                     .srcStageMask = memory->srcStageMask | from,
                                     .srcAccessMask = memory->srcAccessMask | block->write_access,
                                     .dstStageMask = memory->dstStageMask | stage,
                                     .dstAccessMask = memory->dstAccessMask | accesses[access].access};
    block->owner = image;
    if (write) {
        block->write_stage = stage;
        block->write_access = accesses[access].access;
        block->read_stages = 0;
    } else block->read_stages |= stage;
}

void barriers_record(struct barriers *barriers, struct gpu *gpu) {
    const bool memory = barriers->memory.srcStageMask != 0;
    const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                   .memoryBarrierCount = memory,
                                   .pMemoryBarriers = &barriers->memory,
                                   .imageMemoryBarrierCount = barriers->count,
                                   .pImageMemoryBarriers = barriers->images};
    if (memory || barriers->count) vkCmdPipelineBarrier2(gpu->commands, &info);
    barriers->count = 0;
    barriers->memory = (VkMemoryBarrier2){0};
}
