/* Images on the gpu, the memory under them, and who touched them last. */
#ifndef GLINT_REPLAY_IMAGE_H
#define GLINT_REPLAY_IMAGE_H

#include "format.h"
#include "gpu.h"

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

struct image {
    char name[80];
    struct image_desc desc;
    VkImage image; /* NULL: it is a buffer */
    VkBuffer buffer;
    VkBufferView buffer_view;
    VkImageView view;               /* to sample all levels */
    VkImageView array_view;         /* of a cube image, as a cube array; `view` is a cube then. NULL otherwise */
    VkImageView faces_view;         /* of an image with layers, as an array; NULL otherwise */
    VkImageView levels[LEVELS_MAX]; /* to write one: 2D, or an array of all layers */
    struct block *block;
};
VkImageSubresourceRange image_range(const struct image_desc *desc);

/* Creates the image without memory. */
bool image_init(struct image *image, struct gpu *gpu, const char *name, const struct image_desc *desc,
                struct glint_error *err);
VkMemoryRequirements image_requirements(struct gpu *gpu, const struct image *image);
struct block *block_create(struct gpu *gpu, const VkMemoryRequirements *need, const char *name,
                           struct glint_error *err);
/* Binds and makes the views. A block frees itself with its last image. */
bool image_bind(struct image *image, struct gpu *gpu, struct block *block, struct glint_error *err);
bool image_own_memory(struct image *image, struct gpu *gpu, struct glint_error *err);
void image_finish(struct image *image, struct gpu *gpu);

enum { BARRIERS_MAX = 64 };
/* Barriers gathered for one step: one for all memory, and one for each image that takes over its memory. */
struct barriers {
    VkMemoryBarrier2 memory;
    VkImageMemoryBarrier2 images[BARRIERS_MAX];
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
void barriers_record(struct barriers *barriers, struct gpu *gpu);

/* Records copies between tightly packed host memory and a level of the image, barriers included. An upload of some layers (of
   cube maps; 0, 1 for a plain image) discards the others with `discard`. */
void image_record_upload(struct image *image, struct gpu *gpu, const struct host_buffer *from, VkDeviceSize offset,
                         uint32_t level, uint32_t first_layer, uint32_t layers, bool discard);
void image_record_readback(struct image *image, struct gpu *gpu, const struct host_buffer *to, VkDeviceSize offset,
                           uint32_t level);
/* Records filling with one value. */
void image_record_clear(struct image *image, struct gpu *gpu, double value);
/* Makes device writes to host buffers visible to the host; last thing before a submit. */
void record_host_barrier(struct gpu *gpu);

#endif
