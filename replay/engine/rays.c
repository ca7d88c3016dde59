/* Several rays a pixel: images that passes accumulate are summed after each ray, and after the last ray they become the mean, each level by
   itself. */
#include "run.h"

#include <stdlib.h>

#include "spirv_accumulate.h"

struct sum {
    struct image *of;
    uint32_t level;
    struct image sum;
    VkDescriptorSet set;
};

struct rays {
    struct sum *sums;
    size_t count;
    const struct program *program;
};

enum { BINDING_IMAGE, BINDING_SUM, BINDING_MEAN, BINDINGS };

/* Declared like a pass, so that its program can be created like theirs. */
static const struct glint_row rows[BINDINGS] = {
    {.kind = GLINT_ROW_READ, .id = BINDING_IMAGE, .name = "image", .glsl = "texture2D"},
    {.kind = GLINT_ROW_WRITE, .id = BINDING_SUM, .name = "sum", .glsl = "image2D", .format = GLINT_FORMAT_RGBA32F},
    {.kind = GLINT_ROW_WRITE, .id = BINDING_MEAN, .name = "mean", .glsl = "image2D"}};
static const struct glint_pass accumulate = {.slot = "accumulate",
                                             .variant = "built in",
                                             .rows = rows,
                                             .row_count = BINDINGS,
                                             .spirv = spirv_accumulate,
                                             .spirv_bytes = sizeof spirv_accumulate,
                                             .unprobed = spirv_accumulate,
                                             .unprobed_bytes = sizeof spirv_accumulate};
enum { PUSH_WORDS = 4 };

static bool describe_sum(const struct run *run, struct sum *sum, struct glint_error *err) {
    const VkImageView level = sum->of->levels[sum->level], views[BINDINGS] = {level, sum->sum.levels[0], level};
    if (!descriptors_allocate(run->gpu, run->descriptors, &run->rays->program->images, sum->of->name, &sum->set, err))
        return false;
    for (uint32_t b = 0; b < BINDINGS; b++)
        descriptor_set_image(run->gpu, sum->set, b, 0, row_descriptor(&rows[b]), views[b], VK_NULL_HANDLE);
    return true;
}

static uint32_t length_of(uint32_t length, uint32_t level) {
    return length >> level ? length >> level : 1;
}

static bool add_sum(struct run *run, struct image *of, uint32_t level, struct glint_error *err) {
    struct gpu *gpu = run->gpu;
    struct sum *sum = &run->rays->sums[run->rays->count];
    const struct image_desc desc = {.format = GLINT_FORMAT_RGBA32F,
                                    .width = length_of(of->desc.width, level),
                                    .height = length_of(of->desc.height, level),
                                    .levels = 1};
    sum->of = of;
    sum->level = level;
    if (!image_init(&sum->sum, gpu, "sum", &desc, err)) return false;
    run->rays->count++; /* from here on rays_release frees it */
    return image_own_memory(&sum->sum, gpu, err) && describe_sum(run, sum, err);
}

/* The k-th level of the images that executing passes of the loop accumulate; NULL past the last. */
static struct image *accumulated_level(const struct run *run, uint32_t k, uint32_t *level) {
    const struct graph *graph = run->graph;
    for (size_t p = graph->loop_first; p < graph->loop_end; p++)
        for (size_t r = 0; run->steps[p].execute && r < graph->passes[p].pass->row_count; r++) {
            const struct glint_row *row = &graph->passes[p].pass->rows[r];
            if (row->kind != GLINT_ROW_ACCUMULATE) continue;
            struct image *image = &run_image(run, row->name)->image;
            *level = k;
            if (k < image->desc.levels) return image;
            k -= image->desc.levels;
        }
    return NULL;
}

uint32_t rays_sums(const struct run *run) {
    uint32_t count = 0, level;
    while (accumulated_level(run, count, &level)) count++;
    return count;
}

bool rays_prepare(struct run *run, uint32_t sums, struct glint_error *err) {
    const struct constants constants = {.push_count = PUSH_WORDS};
    if (sums == 0) return true;
    run->rays = calloc(1, sizeof *run->rays);
    if (!run->rays || !(run->rays->sums = calloc(sums, sizeof *run->rays->sums)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    struct spirv spirv;
    const struct pipeline_pass entry = {.pass = &accumulate};
    if (!spirv_find(&spirv, &run->engine->device->shaders, &entry, err)) return false;
    run->rays->program =
        programs_get(&run->engine->device->programs, run->gpu, &accumulate, &spirv, &constants, false, err);
    bool ok = run->rays->program != NULL;
    for (uint32_t k = 0, level; ok && k < sums; k++) {
        struct image *of = accumulated_level(run, k, &level);
        ok = add_sum(run, of, level, err);
    }
    return ok;
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
        vkCmdDispatch(commands, (sum->sum.desc.width + 7) / 8, (sum->sum.desc.height + 7) / 8, 1);
    }
    device_end_label(gpu);
}

void rays_release(struct run *run) {
    struct rays *rays = run->rays;
    struct gpu *gpu = run->gpu;
    if (!rays) return;
    for (size_t i = 0; i < rays->count; i++) image_finish(&rays->sums[i].sum, gpu);
    free(rays->sums);
    free(rays);
    run->rays = NULL;
}
