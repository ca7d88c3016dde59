/* How much of an image the tiles of a list cover. */
#include "run.h"

#include "shared/tile_list.h"

/* Tiles at the picture's border are cut off there. */
static uint64_t count_tiles(const struct run *run, const struct dispatch *dispatch, const uint32_t *words) {
    const uint32_t *list = words + tile_begin(run->sizes, dispatch->tile_wide);
    const uint32_t total = tile_count(run->sizes, dispatch->tile_wide),
                   *range = list + TILE_RANGES + 2 * dispatch->tiles;
    const uint32_t width = dispatch->over->width, height = dispatch->over->height;
    const struct extent size = tile_extent(run->sizes, dispatch->over, dispatch->tile_wide);
    uint64_t texels = 0;
    for (uint32_t i = 0; i < range[1]; i++) {
        const uint32_t tile = list[TILE_ITEMS + (range[0] + i) % total];
        const uint32_t left = width - size.width * (tile & 0xFFFF), below = height - size.height * (tile >> 16);
        texels += (uint64_t)(left < size.width ? left : size.width) * (below < size.height ? below : size.height);
    }
    return texels;
}

static bool count_tiles_of(struct run *run, struct pooled *list, struct host_buffer *buffer, struct glint_error *err) {
    VkDeviceSize offset;
    if (!pool_readback(run->pool, &(struct image_part){list, &list->levels[0].info}, 1, buffer, &offset, err))
        return false;
    for (size_t p = 0; p < run->graph->pass_count; p++)
        for (size_t d = 0; d < run->steps[p].dispatch_count; d++)
            if (run->steps[p].dispatches[d].list == list && !run->steps[p].dispatches[d].rest)
                run->steps[p].texels += count_tiles(run, &run->steps[p].dispatches[d], buffer->map);
    return true;
}

bool run_count_tiles(struct run *run, struct glint_error *err) {
    struct host_buffer buffer = {0};
    bool ok = true;
    for (size_t i = 0; ok && i < run->graph->image_count; i++)
        if (run->graph->images[i].row->size == GLINT_SIZE_TILES && run->graph->images[i].source == SOURCE_MADE &&
            run->images[i]->key == run->keys[i])
            ok = count_tiles_of(run, run->images[i], &buffer, err);
    host_buffer_finish(&buffer, run->gpu);
    return ok;
}
