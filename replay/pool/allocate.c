/* Allocates the device images of a run. Images of earlier runs are reused if their descriptions are equal. If the caller names its outputs,
   all other images may share memory with images whose lifetimes do not overlap theirs. */
#include "pool.h"

#include <stdlib.h>

/* Whether an image may share its memory. Images that depend on cube maps alone serve the next frame, and lists are read back for statistics. */
static bool is_transient(const struct frame_plan *plan, const struct graph_image *image) {
    return plan->options->outputs && image->source == SOURCE_MADE && !image->requested && !image->kept &&
           !size_is_buffer(image->row->size) && !image->pass->host && !plan->graph.passes[image->maker].cached_work;
}

struct shared_block {
    struct block *block;
    uint32_t memory_types;
};

/* The images that memory is bound to. */
struct binding {
    struct gpu *gpu;
    const struct graph *graph;
    struct pooled **images; /* one for each image of the graph */
};

static bool is_in_use(const struct binding *b, const struct block *block, size_t i) {
    const struct graph_image *image = &b->graph->images[i];
    for (size_t j = 0; j < b->graph->image_count; j++) {
        const struct graph_image *other = &b->graph->images[j];
        if (j != i && b->images[j] && b->images[j]->image.block == block && other->first_use <= image->last_use &&
            image->first_use <= other->last_use)
            return true;
    }
    return false;
}

/* Binds the transient images, the largest first, so that a block has the size of its first image. */
static bool share_memory(const struct binding *b, struct glint_error *err) {
    size_t count = b->graph->image_count, blocks = 0;
    struct shared_block *shared = calloc(count + 1, sizeof *shared);
    bool ok = shared || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    while (ok) {
        size_t largest = count, s = 0;
        VkMemoryRequirements need = {0};
        for (size_t i = 0; i < count; i++) {
            if (!b->images[i] || b->images[i]->image.block || !b->images[i]->transient) continue;
            VkMemoryRequirements own = image_requirements(b->gpu, &b->images[i]->image);
            if (largest == count || own.size > need.size) largest = i, need = own;
        }
        if (largest == count) break;
        while (s < blocks && (shared[s].block->size < need.size || shared[s].memory_types != need.memoryTypeBits ||
                              is_in_use(b, shared[s].block, largest)))
            s++;
        if (s == blocks) {
            shared[s] =
                (struct shared_block){block_create(b->gpu, &need, "shared by images", err), need.memoryTypeBits};
            if (!shared[s].block) ok = false;
            blocks += ok;
        }
        ok = ok && image_bind(&b->images[largest]->image, b->gpu, shared[s].block, err);
    }
    free(shared);
    return ok;
}

bool pool_allocate(struct pool *pool, const struct frame_plan *plan, struct pooled **images, struct glint_error *err) {
    struct pooled *taken = NULL, **end = &taken;
    bool ok = true;
    pool->begun |= !plan->interim;
    for (struct pooled *image = pool->images; image; image = image->next) {
        image->used = false;
        pooled_hide(image);
        if (image->lineage == plan->options->lineage) image->kept = false;
    }
    for (size_t i = 0; ok && i < plan->graph.image_count; i++) {
        const struct graph_image *planned = &plan->graph.images[i];
        struct image_desc desc;
        if (!(ok = plan_describe(plan, planned, &desc, err))) break;
        const bool transient = is_transient(plan, planned);
        struct pooled *image = transient ? NULL : pool_take(pool, plan, planned, &desc);
        if (!image) image = pooled_create(pool, planned->name, &desc, err);
        if (!(ok = image != NULL)) break;
        image->next = NULL;
        *end = image;
        end = &image->next;
        image->transient = transient;
        images[i] = image;
        pool_adopt(pool, plan, i, image);
    }
    /* Old images are released before new memory is allocated. After a failure they may still serve a later run. */
    if (ok && !plan->interim) pool_trim(pool, plan->options->keep_bytes);
    *end = pool->images;
    pool->images = taken;
    for (size_t i = 0; ok && i < plan->graph.image_count; i++)
        if (!images[i]->image.block && !images[i]->transient) ok = pooled_own_memory(images[i], pool->gpu, err);
    ok = ok && share_memory(&(struct binding){pool->gpu, &plan->graph, images}, err);
    for (struct pooled *image = pool->images; image && !ok; image = image->next)
        image->transient |= !image->image.bound; /* no later run can use it */
    return ok;
}
