/* Writes a step's descriptors and records its barriers and dispatches. */
#include <string.h>

#include "run.h"

/* Cube maps can be sampled by direction or fetched as an array of faces. */
static VkImageView sampled_view(const struct image *image, const char *kind) {
    if (strstr(kind, "2DArray")) return image->faces_view;
    return strstr(kind, "CubeArray") ? image->array_view : image->view;
}

static void write_descriptors(const struct run *run, const struct step *step, const struct dispatch *dispatch) {
    const struct glint_pass *pass = step->pass->pass;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!row_is_image(row)) continue;
        const struct image *image = &run_bound(run, row)->image;
        const uint32_t coarsest = image->desc.levels - 1;
        for (uint32_t i = 0; i < row_bindings(row); i++) {
            const uint32_t level = dispatch->level + i < coarsest ? dispatch->level + i : coarsest;
            const VkImageView view = row_is_sampled(row) ? sampled_view(image, row->glsl) : image->levels[level];
            descriptor_set_image(run->gpu, dispatch->set, row->id, i, row_descriptor(row), view, image->buffer_view);
        }
    }
}

bool step_describe(const struct run *run, struct step *step, struct glint_error *err) {
    for (size_t d = 0; d < step->dispatch_count; d++) {
        struct dispatch *dispatch = &step->dispatches[d];
        if (!descriptors_allocate(run->gpu, run->descriptors, &dispatch->program->images, step->pass->pass->slot,
                                  &dispatch->set, err))
            return false;
        write_descriptors(run, step, dispatch);
    }
    return true;
}

/* Barriers before a dispatch. An image that the pass writes may also be read by it, at other MIP levels. */
static void access_images(const struct run *run, const struct glint_pass *pass, struct barriers *barriers) {
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        bool own = false;
        for (size_t s = 0; s < pass->row_count && glint_row_is_output(row); s++)
            own |= pass->rows[s].kind == GLINT_ROW_READ_OWN && strcmp(row_image(&pass->rows[s]), row->name) == 0;
        if (row_is_image(row) && row->kind != GLINT_ROW_READ_OWN && row->kind != GLINT_ROW_WRITE_LEVELS)
            image_access(&run_bound(run, row)->image,
                         own                        ? IMAGE_SHADER_BOTH
                         : glint_row_is_output(row) ? IMAGE_SHADER_WRITE
                                                    : IMAGE_SHADER_READ,
                         barriers);
    }
}

void step_record(const struct run *run, struct step *step) {
    struct gpu *gpu = run->gpu;
    VkCommandBuffer commands = gpu->commands;
    for (size_t d = 0; d < step->dispatch_count; d++) {
        const struct dispatch *dispatch = &step->dispatches[d];
        const VkDescriptorSet sets[] = {dispatch->set, run->frame_set, run->values_set};
        const bool generic = dispatch->program->generic;
        const uint32_t own_values = (uint32_t)(step - run->steps) * VALUES_BYTES;
        const VkPipelineLayout layout = dispatch->program->layout;
        uint32_t *push = step->constants.push;
        push[0] = dispatch->level; /* the first member of push_begin.glsl */
        struct barriers barriers = {0};
        if (dispatch->list) image_access(&dispatch->list->image, IMAGE_GROUPS, &barriers);
        if (!dispatch->rest || glint_pass_row(step->pass->pass, GLINT_ROW_READ_OWN,
                                              NULL)) /* otherwise it writes other tiles than the dispatch before */
            access_images(run, step->pass->pass, &barriers);
        probes_access(step, &barriers);
        barriers_record(&barriers, gpu);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, dispatch->program->pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, generic ? 3 : 2, sets, generic,
                                &own_values);
        vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, step->constants.push_count * 4, push);
        const uint32_t *groups = dispatch->groups;
        for (uint32_t i = 0; i < dispatch->layer_runs; i++)
            vkCmdDispatchBase(commands, 0, 0, dispatch->layers[i].first, groups[0], groups[1],
                              dispatch->layers[i].count);
        if (dispatch->layers) continue;
        if (dispatch->list) vkCmdDispatchIndirect(commands, dispatch->list->image.buffer, dispatch->from);
        else vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
    }
}
