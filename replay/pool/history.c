/* History: images of the previous frame, which are renamed when the next frame of a shot is loaded. */
#include "pool.h"

#include <stdio.h>
#include <string.h>

void pool_age(struct pool *pool, const struct glint_frame *next) {
    const bool follows = pool->loaded && pool->ran && next->number == pool->number + 1;
    for (struct pooled *image = pool->images; image; image = image->next) image->transient |= pooled_is_history(image);
    pool_drop(pool, false);
    for (struct pooled *image = pool->images; image; image = image->next) {
        char name[sizeof image->image.name];
        const bool is_history = follows && image->kept && image->key;
        image->kept = false;
        if (!is_history) continue;
        snprintf(name, sizeof name, HISTORY_PREFIX "%.64s", image->kept_as ? image->kept_as : image->image.name);
        pooled_rename(image, name);
    }
    pool->number = next->number;
    pool->loaded = true;
    pool->ran = false;
}

void pool_end_run(struct pool *pool, uint32_t lineage, bool ok) {
    pool->ran |= ok;
    for (struct pooled *image = pool->images; image && !ok && pool->begun; image = image->next)
        if (image->lineage == lineage)
            image->kept = false; /* of this run or of an earlier one: of neither there are all */
    pool->begun = false;
    pool_drop(pool, false);
}

bool pool_has_history(const struct pool *pool) {
    for (const struct pooled *image = pool->images; image; image = image->next)
        if (pooled_is_history(image)) return true;
    return false;
}

bool pool_holds_history(const struct pool *pool, const char *name, uint32_t lineage, const struct image_desc *desc) {
    for (const struct pooled *image = pool->images; image; image = image->next)
        if (strcmp(image->image.name, name) == 0 && image->lineage == lineage)
            return image->key && image_desc_equal(&image->image.desc, desc);
    return false;
}
