/* Device images of a run. They stay for the next run while their descriptions are the same; where the caller names the
   outputs it wants, the other images share memory when their lifetimes do not overlap. */
#include "state.h"

#include <stdlib.h>
#include <string.h>

/* What is made from cube maps alone serves the next frame too, and lists are counted. */
static bool is_transient(const struct run *run, const struct graph_image *image) {
    return run->options->outputs && image->source == SOURCE_MADE && !image->wanted && !image->kept &&
           !size_is_buffer(image->row->size) && !image->pass->host && !run->graph.passes[image->maker].cached_work;
}

struct shared_block {
    struct block *block;
    uint32_t memory_types;
};

static bool overlaps(const struct run *run, const struct block *block, size_t i) {
    const struct graph_image *image = &run->graph.images[i];
    for (size_t j = 0; j < run->graph.image_count; j++) {
        const struct graph_image *other = &run->graph.images[j];
        if (j != i && run->images[j] && run->images[j]->block == block && other->first_use <= image->last_use &&
            image->first_use <= other->last_use)
            return true;
    }
    return false;
}

/* Binds the transient images, the largest first, so that the first image of a block is its largest. */
static bool share_memory(struct run *run, struct glint_error *err) {
    struct glint_device *device = run->replay->device;
    size_t count = run->graph.image_count, blocks = 0;
    struct shared_block *shared = calloc(count + 1, sizeof *shared);
    bool ok = shared || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    while (ok) {
        size_t largest = count;
        VkMemoryRequirements need = {0};
        for (size_t i = 0; i < count; i++) {
            if (!run->images[i] || run->images[i]->block || !run->images[i]->transient) continue;
            VkMemoryRequirements own = image_requirements(device, run->images[i]);
            if (largest == count || own.size > need.size) largest = i, need = own;
        }
        if (largest == count) break;
        size_t b = 0;
        while (b < blocks && (shared[b].block->size < need.size || shared[b].memory_types != need.memoryTypeBits ||
                              overlaps(run, shared[b].block, largest)))
            b++;
        if (b == blocks) {
            shared[b] =
                (struct shared_block){block_create(device, &need, "shared by images", err), need.memoryTypeBits};
            if (!shared[b].block) ok = false;
            blocks += ok;
        }
        ok = ok && image_bind(run->images[largest], device, shared[b].block, err);
    }
    free(shared);
    return ok;
}

bool run_allocate(struct run *run, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    struct image *taken = NULL, **end = &taken;
    for (struct image *image = replay->images; image; image = image->next) {
        image->used = false;
        image_hide(image);
        if (image->lineage == run->options->lineage) image->kept = false;
    }
    for (size_t i = 0; i < run->graph.image_count; i++) {
        const struct graph_image *wanted = &run->graph.images[i];
        struct image_desc desc;
        if (!run_describe_image(run, wanted, &desc, err)) goto fail;
        const bool transient = is_transient(run, wanted);
        struct image *image = transient ? NULL : replay_take_image(replay, run, wanted, &desc);
        if (!image && !(image = image_create(replay->device, wanted->name, &desc, err))) goto fail;
        image->next = NULL;
        *end = image;
        end = &image->next;
        image->transient = transient;
        run_adopt(run, i, image);
    }
    if (!run->survey) replay_trim_images(replay, run->options->keep_bytes); /* before memory is taken for new ones */
    *end = replay->images;
    replay->images = taken;
    for (size_t i = 0; i < run->graph.image_count; i++)
        if (!run->images[i]->block && !run->images[i]->transient &&
            !image_own_memory(run->images[i], replay->device, err))
            return false;
    return share_memory(run, err);
fail:
    *end = replay->images; /* their contents may serve a later run */
    replay->images = taken;
    return false;
}
