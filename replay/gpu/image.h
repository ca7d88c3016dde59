/* Images on the device, their memory, and how it was last accessed. */
#ifndef GLINT_REPLAY_IMAGE_H
#define GLINT_REPLAY_IMAGE_H

#include "format.h"
#include "gpu.h"

struct image;

/* Device memory with its access state. Images whose lifetimes do not overlap may share it. The state belongs to the memory, so that an
   image waits for the last access through any other one. */
struct block {
    VkDeviceMemory memory;
    VkDeviceSize size;
    size_t images;             /* number of images that are bound to it */
    const struct image *owner; /* the image whose contents it holds, or NULL */
    VkPipelineStageFlags2 write_stage, read_stages;
    VkAccessFlags2 write_access;
};

struct image {
    char name[80];
    struct image_desc desc;
    VkImage image; /* NULL for a buffer */
    VkBuffer buffer;
    VkBufferView buffer_view;
    VkImageView view;               /* samples all MIP levels; a cube for cube images */
    VkImageView array_view;         /* of a cube image as a cube array, else NULL */
    VkImageView faces_view;         /* of an image with layers as a 2D array, else NULL */
    VkImageView levels[LEVELS_MAX]; /* each MIP level for writing: 2D, or a 2D array of all layers */
    struct block *block;
    bool bound; /* it has all of its views */
};
VkImageSubresourceRange image_range(const struct image_desc *desc);

/* Creates the image without memory. */
bool image_init(struct image *image, struct gpu *gpu, const char *name, const struct image_desc *desc,
                struct glint_error *err);
VkMemoryRequirements image_requirements(struct gpu *gpu, const struct image *image);
struct block *block_create(struct gpu *gpu, const VkMemoryRequirements *need, const char *name,
                           struct glint_error *err);
/* Binds the memory and creates the views. The block is freed with its last image. */
bool image_bind(struct image *image, struct gpu *gpu, struct block *block, struct glint_error *err);
bool image_own_memory(struct image *image, struct gpu *gpu, struct glint_error *err);
void image_finish(struct image *image, struct gpu *gpu);

enum { BARRIERS_MAX = 64 };
/* Barriers before one step: a memory barrier, and an image barrier for each image that takes over memory of another. */
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
    IMAGE_GROUPS /* workgroup counts of an indirect dispatch */
};
/* Declares that the next step accesses the image and adds the barrier that this requires. */
void image_access(struct image *image, enum image_access access, struct barriers *barriers);
void barriers_record(struct barriers *barriers, struct gpu *gpu);

/* Record copies, with barriers, between tightly packed host memory and a MIP level of the image. An upload writes `layers` layers from
   `first_layer` on (0, 1 for a plain image); with `discard` the image's old contents are lost. */
void image_record_upload(struct image *image, struct gpu *gpu, const struct host_buffer *from, VkDeviceSize offset,
                         uint32_t level, uint32_t first_layer, uint32_t layers, bool discard);
void image_record_readback(struct image *image, struct gpu *gpu, const struct host_buffer *to, VkDeviceSize offset,
                           uint32_t level);
/* Records filling all texels with a value. */
void image_record_clear(struct image *image, struct gpu *gpu, double value);
/* Makes the device's writes to host buffers visible to the host. Call it last before the submit. */
void record_host_barrier(struct gpu *gpu);

#endif
