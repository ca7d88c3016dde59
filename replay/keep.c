/* Images that stay on the device beside those of the run: an earlier pipeline's, which it finds again, and what it read
   of the capture. A name may stand for several, with other contents each. */
#include "state.h"

#include <string.h>

bool image_is_history(const struct image *image) {
    return strncmp(image->name, HISTORY_PREFIX, strlen(HISTORY_PREFIX)) == 0;
}

/* What another lineage's next frame will remember is not for this run to take. */
static bool fits(const struct image *image, const struct run *run, const char *name, const struct image_desc *desc) {
    return !image->used && strcmp(image->name, name) == 0 && image_desc_equal(&image->desc, desc) &&
           !(image->kept && image->lineage != run->options->lineage);
}

static void take_out(struct glint_replay *replay, const struct image *image) {
    struct image **at = &replay->images;
    while (*at != image) at = &(*at)->next;
    *at = image->next;
}

struct image *replay_take_image(struct glint_replay *replay, const struct run *run, const struct graph_image *wanted,
                                const struct image_desc *desc) {
    struct image *found = NULL;
    for (struct image *image = replay->images; image; image = image->next) {
        if (!fits(image, run, wanted->name, desc)) continue;
        if (wanted->history && image->lineage != run->options->lineage) continue;
        if (!found || image->used_at > found->used_at) found = image;
    }
    if (found) take_out(replay, found);
    return found;
}

void replay_drop_images(struct glint_replay *replay, bool all) {
    for (struct image **at = &replay->images; *at;) {
        struct image *image = *at;
        if (all || image->transient) {
            *at = image->next;
            image_destroy(&image, replay->device);
        } else at = &image->next;
    }
}

/* What was not used for longest, when those that nobody uses take more than may be kept; NULL otherwise. */
static struct image *find_oldest(struct glint_replay *replay, uint64_t keep_bytes) {
    struct image *oldest = NULL;
    uint64_t bytes = 0;
    for (struct image *image = replay->images; image; image = image->next) {
        if (image->used || image->kept || image_is_history(image)) continue;
        bytes += image_memory_bytes(image);
        if (!oldest || image->used_at < oldest->used_at) oldest = image;
    }
    return bytes > keep_bytes || keep_bytes == 0 ? oldest : NULL;
}

void replay_trim_images(struct glint_replay *replay, uint64_t keep_bytes) {
    for (struct image *oldest; (oldest = find_oldest(replay, keep_bytes));) {
        take_out(replay, oldest);
        image_destroy(&oldest, replay->device);
    }
}

void run_adopt(struct run *run, size_t i, struct image *image) {
    const struct graph_image *wanted = &run->graph.images[i];
    image->used = true;
    image->used_at = run->replay->runs;
    image->kept = wanted->kept;
    image->kept_as = wanted->kept_as;
    image->lineage = run->options->lineage;
    image->listed = (wanted->source == SOURCE_RUN && !wanted->history) || wanted->source == SOURCE_ENGINE ||
                    (wanted->wanted && !wanted->instead) ||
                    (wanted->source == SOURCE_CAPTURE && run->options->captured);
    for (uint32_t l = 0; l < image->desc.levels; l++) {
        image->levels[l].info.row = wanted->row;
        image->levels[l].info.pass = wanted->pass;
    }
    image->as = image->levels[0].info;
    image->as.row = wanted->wanted ? wanted->instead : NULL;
    image->as.pass = wanted->instead_of;
    image->as.name = image->as.row ? image->as.row->name : NULL;
    run->images[i] = image;
}

/* Puts another image into the place of the run's number i, which goes to the others. */
static void replace(struct run *run, size_t i, struct image *image) {
    struct image *old = run->images[i], **at = &run->replay->images;
    while (*at != old) at = &(*at)->next;
    image->next = old->next;
    *at = image;
    old->next = run->replay->images;
    run->replay->images = old;
    old->used = old->kept = false;
    image_hide(old);
    run_adopt(run, i, image);
}

void run_recall(struct run *run) {
    struct glint_replay *replay = run->replay;
    for (size_t i = 0; i < run->graph.image_count; i++) {
        const struct image *own = run->images[i];
        if (own->transient || own->key == run->keys[i]) continue;
        struct image *found = replay->images;
        while (found && !(found->key == run->keys[i] && fits(found, run, own->name, &own->desc))) found = found->next;
        if (!found) continue;
        take_out(replay, found);
        replace(run, i, found);
    }
}

/* Another image like the run's number i: an old one where too much would be kept, else a new one. *other stays NULL where
   the run's own is all that may be kept. */
static bool find_other(struct run *run, size_t i, struct image **other, struct glint_error *err) {
    struct glint_replay *replay = run->replay;
    struct image *own = run->images[i], *oldest;
    own->used = false;
    while ((oldest = find_oldest(replay, run->options->keep_bytes)) && oldest != own) {
        take_out(replay, oldest);
        if (!*other && fits(oldest, run, own->name, &own->desc)) *other = oldest;
        else image_destroy(&oldest, replay->device);
    }
    own->used = true;
    if (oldest == own) image_destroy(other, replay->device);
    if (oldest == own || *other) return true;
    if ((*other = image_create(replay->device, own->name, &own->desc, err)) &&
        image_own_memory(*other, replay->device, err))
        return true;
    image_destroy(other, replay->device);
    return false;
}

bool run_put_aside(struct run *run, struct glint_error *err) {
    for (size_t i = 0; i < run->graph.image_count && run->options->keep_bytes; i++) {
        const struct image *own = run->images[i];
        struct image *other = NULL;
        if (own->transient || !own->key || own->key == run->keys[i] || !run_writes(run, i)) continue;
        if (!find_other(run, i, &other, err)) return false;
        if (other) other->key = 0, replace(run, i, other);
    }
    return true;
}
