/* Images that stay on the device between runs. */
#ifndef GLINT_REPLAY_POOL_H
#define GLINT_REPLAY_POOL_H

#include "frame_plan.h"
#include "image.h"
#include "texels.h"

struct pooled_level {
    struct glint_image info; /* what callers see */
    char name[104];          /* of MIP levels from 1 on */
    struct bad_values
        bad; /* invalid values; of an image that a pass made only valid while bad_key equals the image's key */
    uint64_t bad_key;
};

/* An image on the device, with what it contains, who may use it and how callers see it. */
struct pooled {
    struct image image;
    struct pooled_level levels[LEVELS_MAX];
    uint64_t key;             /* hash of everything that its contents depend on; 0: contents undefined */
    bool quick;               /* a generic program made it, or what it was made from: see glint_replay_options.quick */
    bool listed;              /* visible to callers */
    struct glint_image alias; /* also visible as the image of a dropped pass, unless `row` is NULL */
    bool used;                /* by the current run */
    bool transient;           /* shares its memory */
    bool kept;                /* becomes history of the next frame */
    const char *kept_as;      /* name under which it is kept if not its own, or NULL */
    uint32_t lineage, round;  /* of the run that wrote it: see glint_replay_options */
    uint64_t used_at;         /* number of the last run that used it */
    struct pooled *next;
};

struct pool {
    struct gpu *gpu;
    struct frame_source *source;
    struct pooled *images;
    struct host_buffer staging;
    struct host_buffer readback; /* of single images */
    uint64_t runs;               /* number of runs so far */
    uint32_t number;             /* frame number of the last loaded frame */
    bool loaded, ran;            /* a frame was loaded; a run of it succeeded */
    bool begun;                  /* a run has taken images */
};
void pool_finish(struct pool *pool);
/* Makes pool->staging, a mapped buffer for uploads, at least this large. */
bool pool_stage(struct pool *pool, VkDeviceSize size, struct glint_error *err);

/* Whether the image has the contents that a run needs; `quick`: of a run that also takes those of generic programs. */
static inline bool pooled_has(const struct pooled *pooled, uint64_t key, bool quick) {
    return pooled->key == key && (quick || !pooled->quick);
}

/* keep.c: the i-th image that callers see of a pooled one, which are its MIP levels and its alias; NULL past the last. */
const struct glint_image *pooled_shown(const struct pooled *pooled, uint32_t i);
void pooled_hide(struct pooled *pooled);
/* Renames an image, which makes it unusable for runs that need the old one. */
void pooled_rename(struct pooled *pooled, const char *name);
struct pooled *pooled_create(struct pool *pool, const char *name, const struct image_desc *desc,
                             struct glint_error *err);
bool pooled_own_memory(struct pooled *pooled, struct gpu *gpu, struct glint_error *err);
uint64_t pooled_bytes(const struct pooled *pooled); /* its memory in bytes, 0 if it has none or shares it */
/* The i-th image that callers see (NULL past the last), and the one of a name (or NULL). */
const struct glint_image *pool_shown(const struct pool *pool, size_t i);
const struct glint_image *pool_find(const struct pool *pool, const char *name);
/* Removes an image of an earlier run that can be reused from the pool and returns it, or NULL. */
struct pooled *pool_take(struct pool *pool, const struct frame_plan *plan, const struct graph_image *planned,
                         const struct image_desc *desc);
/* Releases the least recently used images until the unused ones occupy at most keep_bytes. */
void pool_trim(struct pool *pool, uint64_t keep_bytes);
void pool_drop(struct pool *pool, bool all); /* releases the transient images, or all */
/* Makes an image serve as image i of the plan. */
void pool_adopt(struct pool *pool, const struct frame_plan *plan, size_t i, struct pooled *pooled);
/* Replaces images whose contents are outdated by others that already have the required contents (`keys`), if any. */
void pool_recall(struct pool *pool, const struct frame_plan *plan, struct pooled **images, const uint64_t *keys);
/* Replaces images that this run will overwrite by others, so that a later run finds their contents again. */
bool pool_put_aside(struct pool *pool, const struct frame_plan *plan, struct pooled **images, const uint64_t *keys,
                    const bool *written, struct glint_error *err);

/* allocate.c: finds or creates an image with memory for each image of the plan. */
bool pool_allocate(struct pool *pool, const struct frame_plan *plan, struct pooled **images, struct glint_error *err);

/* history.c: images of the previous frame. */
bool pooled_is_history(const struct pooled *pooled);
bool pool_has_history(const struct pool *pool);
bool pool_holds_history(const struct pool *pool, const char *name, uint32_t lineage, const struct image_desc *desc);
/* Call it when another frame is loaded: the kept images of the last frame become history if the frame follows it directly. */
void pool_age(struct pool *pool, const struct glint_frame *next);

/* Call it after each run: images that share memory are released. If the run failed after it had taken images, the frame has no history of its
   lineage to give to the next one; that of other lineages stays. */
void pool_end_run(struct pool *pool, uint32_t lineage, bool ok);

/* readback.c. A MIP level of an image. */
struct image_part {
    struct pooled *image;
    const struct glint_image *info;
};
enum { PASS_PARTS_MAX = PASS_IMAGES_MAX * LEVELS_MAX };
/* Reads parts back into the buffer, which grows if necessary, each tightly packed at its offset. */
bool pool_readback(struct pool *pool, const struct image_part *parts, size_t count, struct host_buffer *buffer,
                   VkDeviceSize *offsets, struct glint_error *err);
/* The MIP levels of all images that callers see as those of a pass, in the order of its rows; at most `capacity`. */
size_t pool_parts(const struct pool *pool, const struct glint_pass *pass, struct image_part *parts, size_t capacity);
/* Implements glint_replay_read_image. */
bool pool_read_image(struct pool *pool, const struct glint_image *info, enum glint_type type, void *out,
                     struct glint_error *err);

#endif
