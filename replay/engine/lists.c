/* Dispatches over the tiles of a list (passes/shared/work_list.h). */
#include "run.h"

#include "shared/work_list.h"

const struct glint_row *step_list(const struct run *run, const struct step *step, size_t r) {
    const struct glint_pass *pass = step->pass->pass;
    while (step->spirv.tiles && ++r < pass->row_count && !row_is_dispatch(&pass->rows[r]))
        if (pass->rows[r].kind == GLINT_ROW_DISPATCH_LIST &&
            graph_find(run->graph, pass->rows[r].name)->source == SOURCE_MADE)
            return &pass->rows[r];
    return NULL;
}

/* Width and height of a tile in texels of an image of the picture. */
static uint32_t tile_side(const struct run *run, const struct image_desc *over) {
    return over->width == run->sizes->full[0] ? TILE_WIDE : TILE_WIDE / 2;
}

bool step_add_list(const struct run *run, struct step *step, uint32_t phase, const struct image_desc *over,
                   const struct glint_row *row, struct glint_error *err) {
    const struct workgroup group = pass_workgroup(step->pass->pass, run->sizes->is_cpu);
    const uint32_t side = tile_side(run, over), tiles = group.width * group.height / (side * side);
    if (tiles != 16 && tiles != 32 && tiles != 64)
        return glint_fail(
            err, GLINT_ERROR_USAGE,
            "%s/%s: DISPATCH_LIST %s: expected 16, 32 or 64 tiles of %u x %u texels in a workgroup, found %u",
            step->pass->pass->slot, step->pass->pass->variant, row->name, side, side, tiles);
    for (uint32_t range = (uint32_t)row->first; range < (uint32_t)row->first + 2; range++)
        step->dispatches[step->dispatch_count++] = (struct dispatch){.phase = phase,
                                                                     .list = run_image(run, row->name),
                                                                     .from = 4 * (12 * range + 4 * (tiles / 32)),
                                                                     .range = range,
                                                                     .over = over,
                                                                     .rest = range != (uint32_t)row->first};
    return true;
}

/* The number of texels of a dispatch. Tiles at the border of the picture may extend beyond it. */
static uint64_t count_texels(const struct run *run, const struct dispatch *dispatch, const uint32_t *list) {
    const uint32_t *range = list + LIST_RANGES + 2 * dispatch->range, total = tile_count(run->sizes);
    const uint32_t width = dispatch->over->width, height = dispatch->over->height;
    const uint32_t side = tile_side(run, dispatch->over);
    uint64_t texels = 0;
    for (uint32_t i = 0; i < range[1]; i++) {
        const uint32_t tile = list[LIST_ITEMS + (range[0] + i) % total];
        const uint32_t left = width - side * (tile & 0xFFFF), below = height - side * (tile >> 16);
        texels += (uint64_t)(left < side ? left : side) * (below < side ? below : side);
    }
    return texels;
}

static bool count_list(struct run *run, struct pooled *list, struct host_buffer *buffer, struct glint_error *err) {
    bool read = false;
    for (size_t p = 0; p < run->graph->pass_count; p++)
        for (size_t d = 0; d < run->steps[p].dispatch_count; d++) {
            const struct dispatch *dispatch = &run->steps[p].dispatches[d];
            VkDeviceSize offset;
            if (dispatch->list != list || dispatch->rest) continue;
            if (!read &&
                !pool_readback(run->pool, &(struct image_part){list, &list->levels[0].info}, 1, buffer, &offset, err))
                return false;
            read = true;
            run->steps[p].texels += count_texels(run, dispatch, buffer->map);
        }
    return true;
}

bool run_count_lists(struct run *run, struct glint_error *err) {
    struct host_buffer buffer = {0};
    bool ok = true;
    for (size_t i = 0; ok && i < run->graph->image_count; i++)
        if (run->images[i]->image.desc.buffer && run->graph->images[i].source == SOURCE_MADE &&
            run->images[i]->key == run->keys[i])
            ok = count_list(run, run->images[i], &buffer, err);
    host_buffer_finish(&buffer, run->gpu);
    return ok;
}
