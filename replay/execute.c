/* Programs and rounds of all passes, timed. */
#include "state.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "timing.h"

static VkResult create_pool(struct run *run, uint32_t sets, uint32_t sampled, uint32_t storage) {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, sampled + 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, storage + 1},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_SAMPLER, 2}};
    const VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = sets + 1,
                                             .poolSizeCount = 4,
                                             .pPoolSizes = sizes};
    return vkCreateDescriptorPool(run->replay->device->device, &info, NULL, &run->pool);
}

static bool prepare_frame_set(struct run *run, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = run->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &replay->programs.frame};
    VkResult result = vkAllocateDescriptorSets(replay->device->device, &info, &run->frame_set);
    if (result != VK_SUCCESS) return vk_fail(err, "allocating descriptors", result);
    device_set_name(replay->device, VK_OBJECT_TYPE_DESCRIPTOR_SET, (uint64_t)(uintptr_t)run->frame_set, "frame");
    memcpy(replay->frame.map, &run->block, sizeof run->block);
    const VkDescriptorBufferInfo buffer = {replay->frame.buffer, 0, sizeof run->block};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = run->frame_set,
                                        .dstBinding = 0,
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                        .pBufferInfo = &buffer};
    vkUpdateDescriptorSets(replay->device->device, 1, &write, 0, NULL);
    return true;
}

static bool prepare_queries(struct run *run, struct glint_error *err) {
    if (!run->replay->device->timestamp_mask || !run->graph.pass_count) return true;
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = 2 * (uint32_t)run->graph.pass_count};
    VkResult result = vkCreateQueryPool(run->replay->device->device, &info, NULL, &run->queries);
    return result == VK_SUCCESS || vk_fail(err, "creating timestamp queries", result);
}

bool run_prepare(struct run *run, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    uint32_t sets = 0, sampled = 0, storage = 0;
    VkDeviceSize groups = 0;
    for (size_t p = 0; p < run->graph.pass_count; p++) {
        struct step *step = &run->steps[p];
        if (!step->pass->runs || step->pass->pass->host) continue;
        if (!step_plan(run, step, err)) return false;
        if (!step->execute) continue;
        for (size_t d = 0; d < step->dispatch_count; d++)
            if (step->dispatches[d].list) step->dispatches[d].at = groups, groups += 4 * sizeof(uint32_t);
        const struct glint_pass *pass = step->pass->pass;
        step->program = programs_get(&replay->programs, replay->device, pass, &step->spirv, &step->constants, err);
        if (!step->program) return false;
        const uint32_t dispatches = (uint32_t)step->dispatch_count;
        sets += dispatches;
        for (size_t r = 0; r < pass->row_count; r++) {
            sampled += dispatches * row_is_sampled(&pass->rows[r]);
            storage += dispatches * row_is_output(&pass->rows[r]);
        }
    }
    if (groups > replay->indirect.size) {
        host_buffer_finish(&replay->indirect, replay->device);
        if (!host_buffer_init(&replay->indirect, replay->device, HOST_BUFFER_INDIRECT, groups, "groups of lists", err))
            return false;
    }
    VkResult result = create_pool(run, sets, sampled, storage);
    if (result != VK_SUCCESS) return vk_fail(err, "creating the descriptor pool", result);
    for (size_t p = 0; p < run->graph.pass_count; p++) {
        struct step *step = &run->steps[p];
        if (step->execute && !step_describe(run, step, err)) return false;
    }
    return prepare_frame_set(run, err) && prepare_queries(run, err);
}

static void record_step(const struct run *run, struct step *step) {
    struct glint_device *device = run->replay->device;
    const struct glint_pass *pass = step->pass->pass;
    const uint32_t query = 2 * (uint32_t)(step - run->steps);
    VkCommandBuffer commands = device->commands;
    char label[128];
    snprintf(label, sizeof label, "%s/%s", pass->slot, pass->variant);
    if (run->queries) vkCmdResetQueryPool(commands, run->queries, query, 2);
    device_begin_label(device, label);
    if (run->queries) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, run->queries, query);
    step_record(run, step);
    if (run->queries) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, run->queries, query + 1);
    device_end_label(device);
}

/* Somebody who follows the progress gets each pass submitted by itself, and can stop between two; otherwise a round is
   one command buffer. */
static bool execute_round(struct run *run, double done, double share, struct glint_error *err) {
    struct glint_device *device = run->replay->device;
    bool recording = false;
    for (size_t p = 0; p < run->graph.pass_count; p++) {
        struct step *step = &run->steps[p];
        if (!step->execute) continue;
        const char *slot = step->pass->pass->slot;
        const double here = done + share * (double)p / (double)run->graph.pass_count;
        if (!report_progress(run->progress, run->user, slot, 0.2 + 0.8 * here, err)) return false;
        if (!recording && !device_begin(device, err)) return false;
        record_step(run, step);
        recording = !run->progress;
        if (!recording && !device_submit(device, slot, err)) return false;
    }
    return !recording || device_submit(device, "running the passes", err);
}

static bool read_times(struct run *run, struct glint_error *err) {
    const struct glint_device *device = run->replay->device;
    for (size_t p = 0; run->queries && p < run->graph.pass_count; p++) {
        struct step *step = &run->steps[p];
        uint64_t ticks[2];
        if (!step->execute) continue;
        VkResult result = vkGetQueryPoolResults(device->device, run->queries, 2 * (uint32_t)p, 2, sizeof ticks, ticks,
                                                sizeof ticks[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        if (result != VK_SUCCESS) return vk_fail(err, "reading timestamps", result);
        const uint64_t passed = (ticks[1] - ticks[0]) & device->timestamp_mask;
        step->ns[step->timed++] = (uint64_t)((double)passed * device->timestamp_ns);
    }
    return true;
}

bool run_execute(struct run *run, struct glint_error *err) {
    const struct glint_replay_options *options = run->options;
    const uint32_t warmup = options->repeat == 0 ? 0 : options->warmup ? options->warmup : 1;
    const uint32_t rounds = warmup + (options->repeat ? options->repeat : 1);
    for (size_t p = 0; p < run->graph.pass_count; p++) {
        struct step *step = &run->steps[p];
        if (!step->execute) continue;
        if (!(step->ns = calloc(rounds, sizeof *step->ns))) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        for (size_t i = 0; i < run->graph.image_count; i++) /* until the new contents are complete */
            if (run->graph.images[i].source == SOURCE_MADE && run->graph.images[i].maker == p) run->images[i]->key = 0;
    }
    for (uint32_t round = 0; round < rounds; round++)
        if (!execute_round(run, (double)round / rounds, 1.0 / rounds, err) ||
            (round >= warmup && !read_times(run, err)))
            return false;
    for (size_t i = 0; i < run->graph.image_count; i++)
        if (run->graph.images[i].source == SOURCE_MADE && !run->images[i]->transient)
            run->images[i]->key = run->keys[i];
    return true;
}

void run_release(struct run *run) {
    VkDevice device = run->replay->device->device;
    vkDestroyQueryPool(device, run->queries, NULL);
    vkDestroyDescriptorPool(device, run->pool, NULL);
    for (size_t p = 0; run->steps && p < run->graph.pass_count; p++) {
        spirv_finish(&run->steps[p].spirv);
        free(run->steps[p].ns);
        free(run->steps[p].dispatches);
    }
    free(run->steps);
    free(run->images);
    free(run->keys);
    for (size_t i = 0; run->given && i < run->graph.image_count; i++) free(run->given[i]);
    free(run->given);
    free(run->needed);
    free(run->active);
    free(run->host_seconds);
    tables_finish(&run->tables);
    graph_finish(&run->graph);
    glint_run_close(&run->inputs);
    glint_run_close(&run->history);
}
