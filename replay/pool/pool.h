/* Images that stay on the device between runs. */
#ifndef GLINT_REPLAY_POOL_H
#define GLINT_REPLAY_POOL_H

#include "frame_plan.h"
#include "image.h"
#include "texels.h"

struct pooled_level {
    struct glint_image info; /* as callers see it */
    char name[104];          /* of levels above 0 */
    struct bad_values bad;   /* of an image that the capture fills, and of others while bad_key is the image's key */
    uint64_t bad_key;
};

/* An image with what it holds, who may use it and how callers see it. */
struct pooled {
    struct image image;
    struct pooled_level levels[LEVELS_MAX];
    uint64_t key;            /* hash of all that its contents depend on; 0: contents undefined */
    bool listed;             /* shown to callers */
    struct glint_image as;   /* shown to them besides, as what a dropped pass would have made; row NULL: no */
    bool used;               /* in this run */
    bool transient;          /* shares its memory */
    bool kept;               /* the next frame's history */
    const char *kept_as;     /* under this name instead of its own, or NULL */
    uint32_t lineage, round; /* of the run that wrote it: see glint_replay_options */
    uint64_t used_at;        /* number of the last run that used it */
    struct pooled *next;
};

struct pool {
    struct gpu *gpu;
    struct frame_source *source;
    struct pooled *images;
    struct host_buffer staging;
    uint64_t runs;    /* how many there were */
    uint32_t number;  /* of the frame loaded last */
    bool loaded, ran; /* a frame was loaded; it was run */
};
void pool_finish(struct pool *pool);
/* A mapped buffer for uploads of at least this size: pool->staging. */
bool pool_stage(struct pool *pool, VkDeviceSize size, struct glint_error *err);

/* keep.c. What callers see of an image, one after the other; NULL: no more. */
const struct glint_image *pooled_shown(const struct pooled *pooled, uint32_t i);
void pooled_hide(struct pooled *pooled);
/* Under another name the image is another one. */
void pooled_rename(struct pooled *pooled, const char *name);
struct pooled *pooled_create(struct pool *pool, const char *name, const struct image_desc *desc,
                             struct glint_error *err);
bool pooled_own_memory(struct pooled *pooled, struct gpu *gpu, struct glint_error *err);
uint64_t pooled_bytes(const struct pooled *pooled); /* of memory of its own, 0 when it has none or shares it */
/* All that callers see, one after the other, and by name; NULL: no more, none. */
const struct glint_image *pool_shown(const struct pool *pool, size_t i);
const struct glint_image *pool_find(const struct pool *pool, const char *name);
/* An image of an earlier run that fits, out of the list; NULL: none. */
struct pooled *pool_take(struct pool *pool, const struct frame_plan *plan, const struct graph_image *wanted,
                         const struct image_desc *desc);
/* The ones not used for longest go, until the others take no more than may be kept. */
void pool_trim(struct pool *pool, uint64_t keep_bytes);
void pool_drop(struct pool *pool, bool all); /* those that serve no later run, or all */
/* The image becomes the plan's number i. */
void pool_adopt(struct pool *pool, const struct frame_plan *plan, size_t i, struct pooled *pooled);
/* Images that hold what is wanted (`keys`) take the place of those that do not. */
void pool_recall(struct pool *pool, const struct frame_plan *plan, struct pooled **images, const uint64_t *keys);
/* Images that hold what an earlier run made, and that this run will write, are put aside for it. */
bool pool_put_aside(struct pool *pool, const struct frame_plan *plan, struct pooled **images, const uint64_t *keys,
                    const bool *written, struct glint_error *err);

/* allocate.c. An image with memory for each of the plan's. */
bool pool_allocate(struct pool *pool, const struct frame_plan *plan, struct pooled **images, struct glint_error *err);

/* history.c. What the frame before left. */
bool pooled_is_history(const struct pooled *pooled);
bool pool_has_history(const struct pool *pool);
bool pool_remembers(const struct pool *pool, const char *name, uint32_t lineage, const struct image_desc *desc);
/* Another frame is loaded: what was kept of the last one becomes its history when it follows. */
void pool_age(struct pool *pool, const struct glint_frame *next);

/* readback.c. One level of an image, as callers see it. */
struct image_part {
    struct pooled *image;
    const struct glint_image *info;
};
enum { PASS_PARTS_MAX = PASS_IMAGES_MAX * LEVELS_MAX };
/* Copies levels of images into the buffer, which grows when it has to, each tightly packed at its offset. */
bool pool_readback(struct pool *pool, const struct image_part *parts, size_t count, struct host_buffer *buffer,
                   VkDeviceSize *offsets, struct glint_error *err);
/* All levels of the images shown as a pass's, in the order of its rows; fills at most `capacity`. */
size_t pool_parts(const struct pool *pool, const struct glint_pass *pass, struct image_part *parts, size_t capacity);
/* As glint_replay_read_image. */
bool pool_read_image(struct pool *pool, const struct glint_image *info, enum glint_type type, void *out,
                     struct glint_error *err);

#endif
