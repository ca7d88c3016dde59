/* Several rays a frame: images that passes accumulate are summed up after each ray and become the mean after the last,
   by a program of our own. */
#include "run.h"

#include <stdlib.h>
#include <string.h>

#include "spirv_accumulate.h"

struct sum {
    struct image *of;
    struct image sum;
    VkDescriptorSet set;
};

struct rays {
    struct sum *sums;
    size_t count;
    VkDescriptorPool pool;
    const struct program *program;
};

enum { BINDING_IMAGE, BINDING_SUM, BINDING_MEAN, BINDINGS };

/* Declared as a pass is, so that its program is made as theirs are. */
static const struct glint_row rows[BINDINGS] = {
    {.kind = GLINT_ROW_READ, .id = BINDING_IMAGE, .name = "image", .glsl = "texture2D"},
    {.kind = GLINT_ROW_WRITE, .id = BINDING_SUM, .name = "sum", .glsl = "image2D", .format = GLINT_FORMAT_RGBA32F},
    {.kind = GLINT_ROW_WRITE, .id = BINDING_MEAN, .name = "mean", .glsl = "image2D"}};
static const struct glint_pass accumulate = {.slot = "accumulate",
                                             .variant = "built in",
                                             .rows = rows,
                                             .row_count = BINDINGS,
                                             .spirv = spirv_accumulate,
                                             .spirv_bytes = sizeof spirv_accumulate};
enum { PUSH_WORDS = 4 };

static bool describe_sum(const struct run *run, struct sum *sum, struct glint_error *err) {
    VkDevice device = run->gpu->device;
    const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = run->rays->pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &run->rays->program->images};
    VkResult result = vkAllocateDescriptorSets(device, &info, &sum->set);
    if (result != VK_SUCCESS) return vk_fail(err, "allocating descriptors", result);
    device_set_name(run->gpu, VK_OBJECT_TYPE_DESCRIPTOR_SET, (uint64_t)(uintptr_t)sum->set, sum->of->name);
    const VkImageView views[BINDINGS] = {sum->of->view, sum->sum.levels[0], sum->of->levels[0]};
    for (uint32_t b = 0; b < BINDINGS; b++) {
        const VkDescriptorImageInfo image = {.imageView = views[b], .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = sum->set,
                                            .dstBinding = b,
                                            .descriptorCount = 1,
                                            .descriptorType = b == BINDING_IMAGE ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
                                                                                 : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                            .pImageInfo = &image};
        vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
    }
    return true;
}

static bool add_sum(struct run *run, struct image *of, struct glint_error *err) {
    struct gpu *gpu = run->gpu;
    struct sum *sum = &run->rays->sums[run->rays->count];
    const struct image_desc desc = {
        .format = GLINT_FORMAT_RGBA32F, .width = of->desc.width, .height = of->desc.height, .levels = 1};
    sum->of = of;
    if (!image_init(&sum->sum, gpu, "sum", &desc, err)) return false;
    run->rays->count++; /* it is released from here on */
    return image_own_memory(&sum->sum, gpu, err) && describe_sum(run, sum, err);
}

static bool create_descriptors(struct run *run, uint32_t sets, struct glint_error *err) {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, sets},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 2 * sets}};
    const VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = sets,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    VkResult result = vkCreateDescriptorPool(run->gpu->device, &info, NULL, &run->rays->pool);
    return result == VK_SUCCESS || vk_fail(err, "creating the descriptor pool", result);
}

bool rays_prepare(struct run *run, struct glint_error *err) {
    const struct graph *graph = &run->plan->graph;
    const struct constants constants = {.push_count = PUSH_WORDS};
    size_t count = 0;
    for (size_t p = graph->loop_first; p < graph->loop_end; p++)
        for (size_t r = 0; run->steps[p].execute && r < graph->passes[p].pass->row_count; r++)
            count += graph->passes[p].pass->rows[r].kind == GLINT_ROW_ACCUMULATE;
    if (count == 0) return true;
    run->rays = calloc(1, sizeof *run->rays);
    if (!run->rays || !(run->rays->sums = calloc(count, sizeof *run->rays->sums)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    struct spirv spirv;
    const struct pipeline_pass entry = {.pass = &accumulate};
    if (!spirv_find(&spirv, &run->engine->device->shaders, &entry, err)) return false;
    run->rays->program = programs_get(&run->engine->device->programs, run->gpu, &accumulate, &spirv, &constants, err);
    if (!run->rays->program || !create_descriptors(run, (uint32_t)count, err)) return false;
    for (size_t p = graph->loop_first; p < graph->loop_end; p++)
        for (size_t r = 0; run->steps[p].execute && r < graph->passes[p].pass->row_count; r++) {
            const struct glint_row *row = &graph->passes[p].pass->rows[r];
            if (row->kind == GLINT_ROW_ACCUMULATE && !add_sum(run, &run_image(run, row->name)->image, err))
                return false;
        }
    return true;
}

void rays_record(const struct run *run, uint32_t ray) {
    struct gpu *gpu = run->gpu;
    VkCommandBuffer commands = gpu->commands;
    const VkPipelineLayout layout = run->rays->program->layout;
    const uint32_t rays = glint_pipeline_rays(run->plan->pipeline), push[PUSH_WORDS] = {0, 0, ray, rays};
    device_begin_label(gpu, "accumulate");
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, run->rays->program->pipeline);
    vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, push);
    for (size_t i = 0; i < run->rays->count; i++) {
        struct sum *sum = &run->rays->sums[i];
        const VkDescriptorSet sets[] = {sum->set, run->frame_set};
        struct barriers barriers = {0};
        image_access(sum->of, IMAGE_SHADER_BOTH, &barriers);
        image_access(&sum->sum, IMAGE_SHADER_STORAGE, &barriers);
        barriers_record(&barriers, gpu);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, sets, 0, NULL);
        vkCmdDispatch(commands, (sum->of->desc.width + 7) / 8, (sum->of->desc.height + 7) / 8, 1);
    }
    device_end_label(gpu);
}

void rays_release(struct run *run) {
    struct rays *rays = run->rays;
    struct gpu *gpu = run->gpu;
    if (!rays) return;
    vkDestroyDescriptorPool(gpu->device, rays->pool, NULL);
    for (size_t i = 0; i < rays->count; i++) image_finish(&rays->sums[i].sum, gpu);
    free(rays->sums);
    free(rays);
    run->rays = NULL;
}
