/* Images that stay on the device besides those of the current run, so that a pipeline finds its own images and those of the capture again.
   There may be several images of one name with different contents. */
#include "pool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool pooled_is_history(const struct pooled *pooled) {
    return strncmp(pooled->image.name, HISTORY_PREFIX, strlen(HISTORY_PREFIX)) == 0;
}

const struct glint_image *pooled_shown(const struct pooled *pooled, uint32_t i) {
    if (pooled->alias.row && i-- == 0) return &pooled->alias;
    return pooled->listed && i < pooled->image.desc.levels ? &pooled->levels[i].info : NULL;
}

void pooled_hide(struct pooled *pooled) {
    pooled->listed = false;
    pooled->alias.row = NULL;
}

const struct glint_image *pool_shown(const struct pool *pool, size_t i) {
    const struct glint_image *shown;
    for (const struct pooled *image = pool->images; image; image = image->next)
        for (uint32_t l = 0; (shown = pooled_shown(image, l)); l++)
            if (i-- == 0) return shown;
    return NULL;
}

const struct glint_image *pool_find(const struct pool *pool, const char *name) {
    const struct glint_image *shown = NULL;
    for (size_t i = 0; (shown = pool_shown(pool, i)) && strcmp(shown->name, name) != 0;) i++;
    return shown;
}

static void name_levels(struct pooled *pooled) {
    char name[sizeof pooled->image.name];
    memcpy(name, pooled->image.name, sizeof name);
    for (uint32_t i = 1; i < pooled->image.desc.levels; i++)
        snprintf(pooled->levels[i].name, sizeof pooled->levels[i].name, "%s.level%u", name, i);
}

void pooled_rename(struct pooled *pooled, const char *name) {
    snprintf(pooled->image.name, sizeof pooled->image.name, "%s", name);
    name_levels(pooled);
}

struct pooled *pooled_create(struct pool *pool, const char *name, const struct image_desc *desc,
                             struct glint_error *err) {
    struct pooled *pooled = calloc(1, sizeof *pooled);
    if (!pooled) glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", name);
    if (!pooled || !image_init(&pooled->image, pool->gpu, name, desc, err)) {
        free(pooled);
        return NULL;
    }
    name_levels(pooled);
    for (uint32_t i = 0; i < desc->levels; i++) {
        const struct extent extent = image_extent(desc, i);
        pooled->levels[i].info = (struct glint_image){.name = i ? pooled->levels[i].name : pooled->image.name,
                                                      .format = desc->format,
                                                      .width = extent.width,
                                                      .height = extent.height * image_layers(desc),
                                                      .components = format_components(desc->format),
                                                      .level = i,
                                                      .levels = desc->levels};
    }
    return pooled;
}

bool pooled_own_memory(struct pooled *pooled, struct gpu *gpu, struct glint_error *err) {
    return image_own_memory(&pooled->image, gpu, err);
}

static void pooled_destroy(struct pooled **pointer, struct gpu *gpu) {
    if (*pointer) image_finish(&(*pointer)->image, gpu);
    free(*pointer);
    *pointer = NULL;
}

uint64_t pooled_bytes(const struct pooled *pooled) {
    return pooled->image.block && !pooled->transient ? pooled->image.block->size : 0;
}

void pool_finish(struct pool *pool) {
    if (!pool->gpu) return;
    pool_drop(pool, true);
    host_buffer_finish(&pool->staging, pool->gpu);
    host_buffer_finish(&pool->readback, pool->gpu);
}

bool pool_stage(struct pool *pool, VkDeviceSize size, struct glint_error *err) {
    if (pool->staging.size >= size) return true;
    host_buffer_finish(&pool->staging, pool->gpu);
    return host_buffer_init(&pool->staging, pool->gpu, HOST_BUFFER_UPLOAD, size, "staging", err);
}

/* Whether the image can be used for `name`. History that another lineage needs for its next frame cannot. */
static bool is_reusable(const struct pooled *image, const struct frame_plan *plan, const char *name,
                        const struct image_desc *desc) {
    return !image->used && !image->transient && strcmp(image->image.name, name) == 0 &&
           image_desc_equal(&image->image.desc, desc) && !(image->kept && image->lineage != plan->options->lineage);
}

static void unlink_image(struct pool *pool, const struct pooled *image) {
    struct pooled **at = &pool->images;
    while (*at != image) at = &(*at)->next;
    *at = image->next;
}

struct pooled *pool_take(struct pool *pool, const struct frame_plan *plan, const struct graph_image *planned,
                         const struct image_desc *desc) {
    struct pooled *found = NULL;
    for (struct pooled *image = pool->images; image; image = image->next) {
        if (!is_reusable(image, plan, planned->name, desc)) continue;
        if (planned->history && image->lineage != plan->options->lineage) continue;
        if (!found || image->used_at > found->used_at) found = image;
    }
    if (found) unlink_image(pool, found);
    return found;
}

void pool_drop(struct pool *pool, bool all) {
    for (struct pooled **at = &pool->images; *at;) {
        struct pooled *image = *at;
        if (all || image->transient) {
            *at = image->next;
            pooled_destroy(&image, pool->gpu);
        } else at = &image->next;
    }
}

/* The least recently used image, if unused images exceed the memory limit; otherwise NULL. */
static struct pooled *find_oldest(struct pool *pool, uint64_t keep_bytes) {
    struct pooled *oldest = NULL;
    uint64_t bytes = 0;
    for (struct pooled *image = pool->images; image; image = image->next) {
        if (image->used || image->kept || pooled_is_history(image)) continue;
        bytes += pooled_bytes(image);
        if (!oldest || image->used_at < oldest->used_at) oldest = image;
    }
    return bytes > keep_bytes || keep_bytes == 0 ? oldest : NULL;
}

void pool_trim(struct pool *pool, uint64_t keep_bytes) {
    for (struct pooled *oldest; (oldest = find_oldest(pool, keep_bytes));) {
        unlink_image(pool, oldest);
        pooled_destroy(&oldest, pool->gpu);
    }
}

void pool_adopt(struct pool *pool, const struct frame_plan *plan, size_t i, struct pooled *image) {
    const struct graph_image *planned = &plan->graph.images[i];
    image->used = true;
    image->used_at = pool->runs;
    image->kept = planned->kept;
    image->kept_as = planned->kept_as;
    image->lineage = plan->options->lineage;
    image->listed = (planned->source == SOURCE_RUN && !planned->history) || planned->source == SOURCE_ENGINE ||
                    (planned->requested && !planned->alias) ||
                    (planned->source == SOURCE_CAPTURE && plan->options->captured);
    for (uint32_t l = 0; l < image->image.desc.levels; l++) {
        image->levels[l].info.row = planned->row;
        image->levels[l].info.pass = planned->pass;
    }
    image->alias = image->levels[0].info;
    image->alias.row = planned->requested ? planned->alias : NULL;
    image->alias.pass = planned->alias_pass;
    image->alias.name = image->alias.row ? image->alias.row->name : NULL;
}

/* Replaces image i of the plan by another image; the old one becomes unused. */
static void replace_image(struct pool *pool, const struct frame_plan *plan, struct pooled **images, size_t i,
                          struct pooled *image) {
    struct pooled *old = images[i], **at = &pool->images;
    while (*at != old) at = &(*at)->next;
    image->next = old->next;
    *at = image;
    old->next = pool->images;
    pool->images = old;
    old->used = old->kept = false;
    pooled_hide(old);
    images[i] = image;
    pool_adopt(pool, plan, i, image);
}

void pool_recall(struct pool *pool, const struct frame_plan *plan, struct pooled **images, const uint64_t *keys) {
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        const struct pooled *own = images[i];
        const bool quick = plan->options->quick;
        if (own->transient || pooled_has(own, keys[i], quick)) continue;
        struct pooled *found = pool->images;
        while (found &&
               !(pooled_has(found, keys[i], quick) && is_reusable(found, plan, own->image.name, &own->image.desc)))
            found = found->next;
        if (!found) continue;
        unlink_image(pool, found);
        replace_image(pool, plan, images, i, found);
    }
}

/* Finds an image with the same description as `own`, so that `own` can be kept: one that would be released for lack of memory, else a new
   one. *other stays NULL if `own` itself would have to be released. */
static bool find_replacement(struct pool *pool, const struct frame_plan *plan, struct pooled *own,
                             struct pooled **other, struct glint_error *err) {
    struct pooled *oldest;
    own->used = false;
    while ((oldest = find_oldest(pool, plan->options->keep_bytes)) && oldest != own) {
        unlink_image(pool, oldest);
        if (!*other && is_reusable(oldest, plan, own->image.name, &own->image.desc)) *other = oldest;
        else pooled_destroy(&oldest, pool->gpu);
    }
    own->used = true;
    if (oldest == own) pooled_destroy(other, pool->gpu);
    if (oldest == own || *other) return true;
    if ((*other = pooled_create(pool, own->image.name, &own->image.desc, err)) &&
        pooled_own_memory(*other, pool->gpu, err))
        return true;
    pooled_destroy(other, pool->gpu);
    return false;
}

bool pool_put_aside(struct pool *pool, const struct frame_plan *plan, struct pooled **images, const uint64_t *keys,
                    const bool *written, struct glint_error *err) {
    for (size_t i = 0; i < plan->graph.image_count && plan->options->keep_bytes; i++) {
        struct pooled *own = images[i], *other = NULL;
        if (own->transient || !own->key || own->key == keys[i] || !written[i]) continue;
        if (!find_replacement(pool, plan, own, &other, err)) return false;
        if (other) other->key = 0, replace_image(pool, plan, images, i, other);
    }
    return true;
}
