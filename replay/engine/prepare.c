/* What a run needs before its passes can be recorded: programs, descriptors, queries. */
#include "run.h"

#include <stdlib.h>
#include <string.h>

static VkResult create_descriptors(struct run *run, uint32_t sets, uint32_t sampled, uint32_t storage) {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, sampled + 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, storage + 1},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, sampled + 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, storage + 1},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_SAMPLER, 2}};
    const VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = sets + 1,
                                             .poolSizeCount = sizeof sizes / sizeof sizes[0],
                                             .pPoolSizes = sizes};
    return vkCreateDescriptorPool(run->gpu->device, &info, NULL, &run->descriptors);
}

static void describe_buffer(const struct run *run, uint32_t binding, VkDescriptorType type,
                            const struct host_buffer *buffer, VkDeviceSize size) {
    const VkDescriptorBufferInfo info = {buffer->buffer, 0, size};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = run->frame_set,
                                        .dstBinding = binding,
                                        .descriptorCount = 1,
                                        .descriptorType = type,
                                        .pBufferInfo = &info};
    vkUpdateDescriptorSets(run->gpu->device, 1, &write, 0, NULL);
}

static bool prepare_frame_set(struct run *run, struct glint_error *err) {
    struct engine *engine = run->engine;
    const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = run->descriptors,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &engine->device->programs.frame};
    VkResult result = vkAllocateDescriptorSets(run->gpu->device, &info, &run->frame_set);
    if (result != VK_SUCCESS) return vk_fail(err, "allocating descriptors", result);
    device_set_name(run->gpu, VK_OBJECT_TYPE_DESCRIPTOR_SET, (uint64_t)(uintptr_t)run->frame_set, "frame");
    memcpy(engine->frame.map, &run->plan->block, sizeof run->plan->block);
    describe_buffer(run, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &engine->frame, sizeof run->plan->block);
    describe_buffer(run, 3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &engine->probes, VK_WHOLE_SIZE);
    return true;
}

static bool prepare_queries(struct run *run, struct glint_error *err) {
    if (!run->gpu->timestamp_mask || !run->plan->graph.pass_count) return true;
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = (uint32_t)run->plan->graph.pass_count + 1};
    VkResult result = vkCreateQueryPool(run->gpu->device, &info, NULL, &run->queries);
    return result == VK_SUCCESS || vk_fail(err, "creating timestamp queries", result);
}

static bool find_programs(const struct run *run, struct step *step, struct glint_error *err) {
    struct constants constants = step->constants;
    for (size_t d = 0; d < step->dispatch_count; d++) {
        struct dispatch *dispatch = &step->dispatches[d];
        constants.data[CONSTANT_PHASE] = dispatch->phase;
        constants.data[PLACE_TILES] = dispatch->tiles;
        constants.data[PLACE_WORKS] = !dispatch->rest;
        if (dispatch->tile_wide) constants.data[PLACE_TILE_WIDE] = dispatch->tile_wide;
        dispatch->program =
            programs_get(&run->engine->device->programs, run->gpu, step->pass->pass, &step->spirv, &constants, err);
        if (!dispatch->program) return false;
    }
    return true;
}

bool run_prepare(struct run *run, struct glint_error *err) {
    uint32_t sets = 0, sampled = 0, storage = 0;
    for (size_t p = 0; p < run->plan->graph.pass_count; p++) {
        struct step *step = &run->steps[p];
        if (!step->pass->runs || step->pass->pass->host) continue;
        if (!step_plan(run, step, err)) return false;
        if (!step->execute) continue;
        const struct glint_pass *pass = step->pass->pass;
        if (!find_programs(run, step, err)) return false;
        const uint32_t dispatches = (uint32_t)step->dispatch_count;
        sets += dispatches;
        for (size_t r = 0; r < pass->row_count; r++) {
            sampled += dispatches * row_is_sampled(&pass->rows[r]);
            storage += dispatches * glint_row_is_output(&pass->rows[r]);
        }
    }
    VkResult result = create_descriptors(run, sets, sampled, storage);
    if (result != VK_SUCCESS) return vk_fail(err, "creating the descriptor pool", result);
    for (size_t p = 0; p < run->plan->graph.pass_count; p++) {
        struct step *step = &run->steps[p];
        if (step->execute && !step_describe(run, step, err)) return false;
    }
    return prepare_frame_set(run, err) && prepare_queries(run, err) && rays_prepare(run, err);
}
