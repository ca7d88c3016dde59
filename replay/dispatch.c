/* What a pass's rows dispatch: a list of dispatches, each with its level, its phase and its descriptors. */
#include "state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shared/tile_list.h"

enum {
#define TILE_RANGE(name, first, end) RANGE_##name,
#include "shared/tile_ranges.h"
#undef TILE_RANGE
    RANGES
};
static const char *const range_names[RANGES] = {
#define TILE_RANGE(name, first, end) #name,
#include "shared/tile_ranges.h"
#undef TILE_RANGE
};

struct image *run_image(const struct run *run, const char *name) {
    const struct graph_image *image = graph_find(&run->graph, name);
    return image ? run->images[image - run->graph.images] : NULL;
}

static struct image *bound(const struct run *run, const struct glint_row *binding) {
    return run->images[graph_bound(&run->graph, binding) - run->graph.images];
}

static bool row_is_dispatch(const struct glint_row *row) {
    return row->kind == GLINT_ROW_DISPATCH || row->kind == GLINT_ROW_DISPATCH_LEVELS ||
           row->kind == GLINT_ROW_DISPATCH_LIST;
}

/* The layers of a level that a dispatch works on; NULL: all. */
static struct face_run *needed_layers(const struct run *run, const struct step *step, const struct glint_row *row,
                                      uint32_t level, uint32_t *count) {
    uint8_t faces[GLINT_SURVEY_CUBEMAPS];
    if (!run_dispatches_faces(run, step->pass->pass, row, level, faces)) return NULL;
    struct face_run *layers = calloc(FACE_RUNS_MAX, sizeof *layers);
    if (layers) *count = face_runs(faces, run->sizes.active, layers);
    return layers;
}

static void add(const struct run *run, struct step *step, uint32_t phase, const struct glint_row *row,
                const struct image *image, uint32_t level) {
    const uint32_t *half = run->sizes.half;
    VkExtent3D extent = image_extent(&image->desc, level);
    struct workgroup group = pass_workgroup(step->pass->pass);
    const uint32_t block = block_width(run, step->pass->pass);
    group.width *= block, group.height *= block;
    const enum glint_size_class size = graph_find(&run->graph, image->name)->row->size;
    if (size == GLINT_SIZE_TILES) {
        extent = (VkExtent3D){run->sizes.full[0], run->sizes.full[1], 1};
        group = (struct workgroup){REGION_WIDE * STRIP_WIDE, REGION_HIGH * TILE_HIGH};
    } else if (image->desc.buffer) {
        extent = (VkExtent3D){half[0], half[1], 1};
        group = (struct workgroup){LIST_BLOCK, LIST_BLOCK};
    }
    struct dispatch *dispatch = &step->dispatches[step->dispatch_count++];
    *dispatch =
        (struct dispatch){.phase = phase,
                          .level = level,
                          .tiles = ALL_TILES,
                          .groups = {(extent.width + group.width - 1) / group.width,
                                     (extent.height + group.height - 1) / group.height, image_layers(&image->desc)}};
    const uint64_t texels = dispatch_texels(run, &image->desc, size, level);
    dispatch->layers = needed_layers(run, step, row, level, &dispatch->layer_runs);
    if (!dispatch->layers) step->texels += texels;
    for (uint32_t i = 0; i < dispatch->layer_runs; i++)
        step->texels += texels / dispatch->groups[2] * dispatch->layers[i].count;
    if (size != GLINT_SIZE_TILES) return;
    dispatch->tile_wide = TILE_WIDE;
    if (run->sizes.tile_wide == TILE_WIDE) return;
    step->dispatches[step->dispatch_count] = *dispatch; /* the list of strips, from that of tiles */
    step->dispatches[step->dispatch_count++].tile_wide = run->sizes.tile_wide;
}

static double value_of(const struct graph_pass *pass, const char *parameter) {
    size_t r = 0;
    while (!row_is_parameter(&pass->pass->rows[r]) || strcmp(pass->pass->rows[r].name, parameter) != 0) r++;
    return pass->entry->values[r];
}

/* The finest level that is no wider than a parameter says. */
static int level_of_width(const struct graph_pass *pass, const struct image_desc *desc, const char *parameter) {
    const double width = value_of(pass, parameter);
    int level = 0;
    while (level < 31 && ldexp(width, level) < desc->width) level++;
    return level;
}

bool dispatch_levels(const struct graph_pass *pass, const struct glint_row *row, const struct image_desc *desc,
                     uint32_t *first, uint32_t *last) {
    const int count = (int)desc->levels;
    const bool swapped = (row->first < 0) == (row->last < 0) ? row->first > row->last : row->first < 0;
    int fine = swapped ? row->last : row->first, coarse = swapped ? row->first : row->last;
    if (row->assigned) {
        const int from = level_of_width(pass, desc, row->assigned);
        fine = from + row->first, coarse = from + row->last;
    } else {
        fine = fine < 0 ? fine + count : fine;
        coarse = coarse < 0 ? coarse + count : coarse;
    }
    if (fine < 0) fine = 0;
    if (coarse > count - 1) coarse = count - 1;
    *first = (uint32_t)fine;
    *last = coarse < 0 ? 0 : (uint32_t)coarse;
    return coarse >= fine;
}

static void add_levels(const struct run *run, struct step *step, uint32_t phase, const struct glint_row *row,
                       const struct image *image) {
    uint32_t fine, coarse;
    if (!dispatch_levels(step->pass, row, &image->desc, &fine, &coarse)) return;
    for (uint32_t i = 0; i <= coarse - fine; i++)
        add(run, step, phase, row, image, row->order == GLINT_ORDER_up ? coarse - i : fine + i);
}

/* The images of the rows DISPATCH_LIST that follow row `r`; 0 when there are none, or one of them was not made. */
static size_t lists_after(const struct run *run, const struct glint_pass *pass, size_t r, struct image **lists) {
    size_t count = 0;
    while (++r < pass->row_count) {
        const struct glint_row *row = &pass->rows[r];
        if (row->kind != GLINT_ROW_DISPATCH_LIST && row_is_dispatch(row)) break;
        if (row->kind != GLINT_ROW_DISPATCH_LIST) continue;
        if (graph_find(&run->graph, row->name)->source == SOURCE_NOTHING) return 0;
        lists[count++] = run_image(run, row->name);
    }
    return count;
}

static struct image *tile_list(const struct run *run, const struct glint_pass *pass) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].optional && pass->rows[r].size == GLINT_SIZE_TILES &&
            graph_find(&run->graph, pass->rows[r].name)->source == SOURCE_MADE)
            return run_image(run, pass->rows[r].name);
    return NULL;
}

/* The row DISPATCH_TILES that follows row `r`, when the list is there and the shader, maybe a user's, knows of tiles. */
static const struct glint_row *tiles_after(const struct run *run, const struct step *step, size_t r) {
    const struct glint_pass *pass = step->pass->pass;
    if (!tile_list(run, pass) || !step->spirv.tiles) return NULL;
    while (++r < pass->row_count && pass->rows[r].kind != GLINT_ROW_DISPATCH &&
           pass->rows[r].kind != GLINT_ROW_DISPATCH_LEVELS)
        if (pass->rows[r].kind == GLINT_ROW_DISPATCH_TILES) return &pass->rows[r];
    return NULL;
}

/* Over the tiles of a range, and over the rest; where the list says with how many workgroups: shared/tile_list.h. */
static bool add_tiles(const struct run *run, struct step *step, uint32_t phase, const struct image *image,
                      const struct glint_row *row, struct glint_error *err) {
    const struct workgroup group = pass_workgroup(step->pass->pass);
    const VkExtent2D size = tile_extent(run, image, STRIP_WIDE);
    const uint32_t strips = group.width * group.height / (size.width * size.height),
                   wide = tile_wide(run, step->pass->pass);
    uint32_t range = 0;
    while (range < RANGES && strcmp(range_names[range], row->name) != 0) range += 2;
    if (range >= RANGES || (strips != 2 && strips != 4 && strips != 8))
        return glint_fail(
            err, GLINT_ERROR_USAGE,
            "%s/%s: DISPATCH_TILES %s: expected a range of tiles, 2, 4 or 8 times %u x %u texels in a workgroup",
            step->pass->pass->slot, step->pass->pass->variant, row->name, size.width, size.height);
    for (uint32_t rest = 0; rest < 2; rest++)
        step->dispatches[step->dispatch_count++] = (struct dispatch){
            .phase = phase,
            .list = tile_list(run, step->pass->pass),
            .from = 4 * (VkDeviceSize)(tile_begin(&run->sizes, wide) + 12 * (range + rest) + 4 * (strips / 4)),
            .tiles = range + rest,
            .over = image,
            .tile_wide = wide,
            .rest = rest};
    return true;
}

bool step_plan(const struct run *run, struct step *step, struct glint_error *err) {
    const struct glint_pass *pass = step->pass->pass;
    step->dispatches = calloc(pass->row_count * LEVELS_MAX, sizeof *step->dispatches);
    if (!step->dispatches) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    struct image *lists[PASS_IMAGES_MAX];
    uint32_t phase = 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!row_is_dispatch(row)) continue;
        const struct image *image = run_image(run, row->name);
        if (!image)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s dispatches over %s, which it neither reads nor writes",
                              pass->slot, pass->variant, row->name);
        const size_t count = row->kind == GLINT_ROW_DISPATCH ? lists_after(run, pass, r, lists) : 0;
        for (size_t i = 0; i < count; i++)
            step->dispatches[step->dispatch_count++] =
                (struct dispatch){.phase = phase + 1 + (uint32_t)i, .list = lists[i], .tiles = ALL_TILES};
        const struct glint_row *tiles =
            row->kind == GLINT_ROW_DISPATCH && count == 0 ? tiles_after(run, step, r) : NULL;
        if (tiles && !add_tiles(run, step, phase, image, tiles, err)) return false;
        if (row->kind == GLINT_ROW_DISPATCH && count == 0 && !tiles) add(run, step, phase, row, image, 0);
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS) add_levels(run, step, phase, row, image);
        phase++;
    }
    if (phase > 0) return true;
    return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s declares no image to dispatch over", pass->slot, pass->variant);
}

/* Cube maps can be sampled by direction, or fetched as an array of faces. */
static VkImageView sampled_view(const struct image *image, const char *kind) {
    if (strstr(kind, "2DArray")) return image->faces_view;
    return strstr(kind, "CubeArray") ? image->array_view : image->view;
}

static void describe(const struct run *run, const struct step *step, const struct dispatch *dispatch) {
    const struct glint_pass *pass = step->pass->pass;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!row_is_image(row)) continue;
        const struct image *image = bound(run, row);
        const uint32_t coarsest = image->desc.levels - 1;
        const bool sampled = row_is_sampled(row);
        const VkDescriptorImageInfo info = {
            .imageView = sampled ? sampled_view(image, row->glsl)
                                 : image->levels[dispatch->level < coarsest ? dispatch->level : coarsest].view,
            .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = dispatch->set,
                                            .dstBinding = row->id,
                                            .descriptorCount = 1,
                                            .descriptorType = row_descriptor(row),
                                            .pImageInfo = &info,
                                            .pTexelBufferView = &image->buffer_view};
        vkUpdateDescriptorSets(run->replay->device->device, 1, &write, 0, NULL);
    }
}

bool step_describe(const struct run *run, struct step *step, struct glint_error *err) {
    struct glint_device *device = run->replay->device;
    for (size_t d = 0; d < step->dispatch_count; d++) {
        struct dispatch *dispatch = &step->dispatches[d];
        const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                  .descriptorPool = run->pool,
                                                  .descriptorSetCount = 1,
                                                  .pSetLayouts = &dispatch->program->images};
        VkResult result = vkAllocateDescriptorSets(device->device, &info, &dispatch->set);
        if (result != VK_SUCCESS) return vk_fail(err, "allocating descriptors", result);
        device_set_name(device, VK_OBJECT_TYPE_DESCRIPTOR_SET, (uint64_t)(uintptr_t)dispatch->set,
                        step->pass->pass->slot);
        describe(run, step, dispatch);
    }
    return true;
}

/* Barriers before a dispatch: an image that the pass writes may also be read by it, at other levels. */
static void access_images(const struct run *run, const struct glint_pass *pass, struct barriers *barriers) {
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        bool own = false;
        for (size_t s = 0; s < pass->row_count && row_is_output(row); s++)
            own |= pass->rows[s].kind == GLINT_ROW_READ_OWN && strcmp(row_image(&pass->rows[s]), row->name) == 0;
        if (row_is_image(row) && row->kind != GLINT_ROW_READ_OWN)
            image_access(bound(run, row),
                         own                  ? IMAGE_SHADER_BOTH
                         : row_is_output(row) ? IMAGE_SHADER_WRITE
                                              : IMAGE_SHADER_READ,
                         barriers);
    }
}

void step_record(const struct run *run, struct step *step) {
    struct glint_device *device = run->replay->device;
    VkCommandBuffer commands = device->commands;
    for (size_t d = 0; d < step->dispatch_count; d++) {
        const struct dispatch *dispatch = &step->dispatches[d];
        const VkDescriptorSet sets[] = {dispatch->set, run->frame_set};
        const VkPipelineLayout layout = dispatch->program->layout;
        uint32_t *push = step->constants.push;
        push[0] = dispatch->level; /* how push_begin.glsl opens the block */
        struct barriers barriers = {0};
        if (dispatch->list) image_access(dispatch->list, IMAGE_GROUPS, &barriers);
        if (!dispatch->rest ||
            pass_row(step->pass->pass, GLINT_ROW_READ_OWN, NULL)) /* else it only writes other tiles */
            access_images(run, step->pass->pass, &barriers);
        probes_access(step, &barriers);
        barriers_record(&barriers, device);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, dispatch->program->pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, sets, 0, NULL);
        vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, step->constants.push_count * 4, push);
        const uint32_t *groups = dispatch->groups;
        for (uint32_t i = 0; i < dispatch->layer_runs; i++)
            vkCmdDispatchBase(commands, 0, 0, dispatch->layers[i].first, groups[0], groups[1],
                              dispatch->layers[i].count);
        if (dispatch->layers) continue;
        if (dispatch->list) vkCmdDispatchIndirect(commands, dispatch->list->buffer, dispatch->from);
        else vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
    }
}
