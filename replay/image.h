/* Images on the device, the memory under them, and who touched them last. */
#ifndef GLINT_REPLAY_IMAGE_H
#define GLINT_REPLAY_IMAGE_H

#include "device.h"
#include "pipeline.h"

struct image;

/* Device memory with its access state. Images may share one when their lifetimes do not overlap; the state belongs to
   the memory, so that a newcomer waits for the last user. */
struct block {
    VkDeviceMemory memory;
    VkDeviceSize size;
    size_t images;             /* how many are bound to it */
    const struct image *owner; /* whose contents it holds; NULL: nobody's */
    VkPipelineStageFlags2 write_stage, read_stages;
    VkAccessFlags2 write_access;
};

/* What an image has to be; equal descriptions can reuse an image. */
struct image_desc {
    enum glint_format format;
    uint32_t width, height, layers; /* of one layer; 0: a plain 2D image */
    bool cube;                      /* the layers are six faces for each cube map */
    uint32_t levels;                /* each half as large as the one before it, at least 1 × 1 */
    bool buffer;                    /* of the texels of a plain 2D image, row by row */
};

/* See bad_values.h. */
struct bad_values {
    uint64_t not_finite, clamped;
    size_t first; /* number of the value, and what it is */
    float value;
};

enum { LEVELS_MAX = 17 };
struct image_level {
    struct glint_image info; /* as callers see it */
    VkImageView view;        /* to write it: 2D, or an array of all layers */
    char name[96];           /* of levels above 0 */
    struct bad_values bad;   /* of an image that the capture fills, and of others while bad_key is the image's key */
    uint64_t bad_key;
};

struct image {
    struct image_level levels[LEVELS_MAX];
    struct image_desc desc;
    VkImage image; /* NULL: it is a buffer */
    VkBuffer buffer;
    VkBufferView buffer_view;
    VkImageView view;       /* to sample all levels */
    VkImageView array_view; /* of a cube image, as a cube array; `view` is a cube then. NULL otherwise */
    VkImageView faces_view; /* of an image with layers, as an array; NULL otherwise */
    struct block *block;
    uint64_t key;            /* hash of all that its contents depend on; 0: contents undefined */
    bool listed;             /* shown to callers */
    struct glint_image as;   /* shown to them besides, as what a dropped pass would have made; row NULL: no */
    bool used;               /* in this run */
    bool transient;          /* shares its memory */
    bool kept;               /* the next frame's history */
    const char *kept_as;     /* under this name instead of its own, or NULL */
    uint32_t lineage, round; /* of the run that wrote it: see glint_replay_options */
    uint64_t used_at;        /* number of the last run that used it */
    char name[80];
    struct image *next;
};

/* What callers see of it, one after the other; NULL: no more. */
const struct glint_image *image_shown(const struct image *image, uint32_t i);
void image_hide(struct image *image);

bool image_desc_equal(const struct image_desc *a, const struct image_desc *b);
uint32_t image_layers(const struct image_desc *desc); /* at least 1 */
VkExtent3D image_extent(const struct image_desc *desc, uint32_t level);
VkImageSubresourceRange image_range(const struct image_desc *desc);
VkDeviceSize image_bytes(const struct image_desc *desc, uint32_t level); /* tightly packed */
size_t image_values(const struct image_desc *desc, uint32_t level);
/* How many levels there are down to 1 × 1. */
uint32_t level_count(uint32_t width, uint32_t height);

/* Creates the image without memory. */
struct image *image_create(struct glint_device *device, const char *name, const struct image_desc *desc,
                           struct glint_error *err);
VkMemoryRequirements image_requirements(struct glint_device *device, const struct image *image);
struct block *block_create(struct glint_device *device, const VkMemoryRequirements *need, const char *name,
                           struct glint_error *err);
/* Binds and makes the views. A block frees itself with its last image. */
bool image_bind(struct image *image, struct glint_device *device, struct block *block, struct glint_error *err);
bool image_own_memory(struct image *image, struct glint_device *device, struct glint_error *err);
/* Under another name the image is another one. */
void image_rename(struct image *image, const char *name);
uint64_t image_memory_bytes(const struct image *image); /* of its own, 0 when it has none or shares it */
void image_destroy(struct image **image, struct glint_device *device);

/* Barriers gathered for one step: one for all memory, and one for each image that takes over its memory. */
struct barriers {
    VkMemoryBarrier2 memory;
    VkImageMemoryBarrier2 images[PASS_IMAGES_MAX];
    uint32_t count;
};
enum image_access {
    IMAGE_SHADER_READ,
    IMAGE_SHADER_WRITE,
    IMAGE_SHADER_BOTH,
    IMAGE_SHADER_STORAGE,
    IMAGE_COPY_READ,
    IMAGE_COPY_WRITE,
    IMAGE_CLEAR,
    IMAGE_GROUPS /* counts of workgroups, by an indirect dispatch */
};
/* Notes that the next step accesses the image, and adds the barrier that this needs. */
void image_access(struct image *image, enum image_access access, struct barriers *barriers);
void barriers_record(struct barriers *barriers, struct glint_device *device);

/* Records copies between tightly packed host memory and a level of the image, barriers included. An upload of some layers (of
   cube maps; 0, 1 for a plain image) discards the others with `discard`. */
void image_record_upload(struct image *image, struct glint_device *device, const struct host_buffer *from,
                         VkDeviceSize offset, uint32_t level, uint32_t first_layer, uint32_t layers, bool discard);
void image_record_readback(struct image *image, struct glint_device *device, const struct host_buffer *to,
                           VkDeviceSize offset, uint32_t level);
/* Records filling with one value. */
void image_record_clear(struct image *image, struct glint_device *device, double value);
/* Makes device writes to host buffers visible to the host; last thing before a submit. */
void record_host_barrier(struct glint_device *device);

#endif
