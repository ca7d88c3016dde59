/* Descriptor pools and sets. */
#include "gpu.h"

#include <stdio.h>

bool descriptors_create(struct gpu *gpu, uint32_t sets, uint32_t images, bool values, VkDescriptorPool *pool,
                        struct glint_error *err) {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, images},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, images},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, images},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, images},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_SAMPLER, 2},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1}};
    const VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = sets,
                                             .poolSizeCount = sizeof sizes / sizeof sizes[0] - !values,
                                             .pPoolSizes = sizes};
    return gpu_ok(gpu, vkCreateDescriptorPool(gpu->device, &info, NULL, pool), "creating the descriptor pool", err);
}

bool descriptors_allocate(struct gpu *gpu, VkDescriptorPool pool, const VkDescriptorSetLayout *layout, const char *name,
                          VkDescriptorSet *set, struct glint_error *err) {
    const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = layout};
    char what[192];
    snprintf(what, sizeof what, "allocating descriptors of %s", name);
    /* It gets no name, which Lavapipe 22.3 would keep after the pool is destroyed. */
    return gpu_ok(gpu, vkAllocateDescriptorSets(gpu->device, &info, set), what, err);
}

static void write_descriptor(struct gpu *gpu, VkWriteDescriptorSet write) {
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.descriptorCount = 1;
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
}

void descriptor_set_image(struct gpu *gpu, VkDescriptorSet set, uint32_t binding, uint32_t element,
                          VkDescriptorType type, VkImageView view, VkBufferView buffer) {
    const VkDescriptorImageInfo info = {.imageView = view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    write_descriptor(gpu, (VkWriteDescriptorSet){.dstSet = set,
                                                 .dstBinding = binding,
                                                 .dstArrayElement = element,
                                                 .descriptorType = type,
                                                 .pImageInfo = &info,
                                                 .pTexelBufferView = &buffer});
}

void descriptor_set_buffer(struct gpu *gpu, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                           const struct host_buffer *buffer, VkDeviceSize size) {
    const VkDescriptorBufferInfo info = {buffer->buffer, 0, size};
    write_descriptor(gpu, (VkWriteDescriptorSet){
                              .dstSet = set, .dstBinding = binding, .descriptorType = type, .pBufferInfo = &info});
}
