/* The Vulkan device: memory, one command buffer at a time, object names. It knows no pass. */
#ifndef GLINT_REPLAY_GPU_H
#define GLINT_REPLAY_GPU_H

#include <pthread.h>

#include <vulkan/vulkan.h>

#include "glint/replay.h"

struct debug_names {
    PFN_vkSetDebugUtilsObjectNameEXT name;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin;
    PFN_vkCmdEndDebugUtilsLabelEXT end;
};

struct messages {
    pthread_mutex_t lock; /* the layer may report from any thread */
    uint32_t count;
    char last[1024];
};

struct instance {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    bool debug_utils;
};

struct gpu {
    struct instance instance;
    struct messages messages;
    struct debug_names debug; /* all NULL without VK_EXT_debug_utils */
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    double timestamp_ns;     /* nanoseconds a tick */
    uint64_t timestamp_mask; /* 0: no timestamps */
    VkPhysicalDeviceMemoryProperties memory;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
    VkPipelineCache cache;
    struct glint_device_info info;
};

/* Creates an instance; `messages` non-NULL switches validation on. */
bool instance_init(struct instance *instance, struct messages *messages, struct glint_error *err);
void instance_finish(struct instance *instance);
/* Devices of an instance, best first. The caller frees both arrays. */
bool instance_devices(VkInstance instance, VkPhysicalDevice **physical, struct glint_device_info **infos, size_t *count,
                      struct glint_error *err);
/* The family that computes and copies; UINT32_MAX when there is none. */
uint32_t device_family(VkPhysicalDevice physical, uint32_t *timestamp_bits);

/* Fails with what was tried and Vulkan's word for the result. */
bool vk_fail(struct glint_error *err, const char *what, VkResult result);
bool vk_ok(VkResult result, const char *what, struct glint_error *err); /* the same unless it is VK_SUCCESS */
VkFormat format_vulkan(enum glint_format format);

/* `select` as in struct glint_device_options; `validate`: the validation layer. Stays where it is. */
bool gpu_init(struct gpu *gpu, const char *select, bool validate, struct glint_error *err);
void gpu_finish(struct gpu *gpu);
/* Waits until nothing runs any more. */
void gpu_wait(struct gpu *gpu);

bool device_allocate(struct gpu *gpu, const VkMemoryRequirements *need, VkMemoryPropertyFlags wanted,
                     VkMemoryPropertyFlags preferred, const char *name, VkDeviceMemory *memory,
                     struct glint_error *err);

/* One command buffer at a time: begin, record, submit and wait. */
bool device_begin(struct gpu *gpu, struct glint_error *err);
bool device_submit(struct gpu *gpu, const char *what, struct glint_error *err);

void device_set_name(struct gpu *gpu, VkObjectType type, uint64_t handle, const char *name);
void device_begin_label(struct gpu *gpu, const char *text);
void device_end_label(struct gpu *gpu);

/* Memory that host and device see, mapped for its whole life. */
struct host_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *map;
    VkDeviceSize size;
};
enum host_buffer_use { HOST_BUFFER_UPLOAD, HOST_BUFFER_READBACK, HOST_BUFFER_UNIFORM, HOST_BUFFER_STORAGE };
bool host_buffer_init(struct host_buffer *buffer, struct gpu *gpu, enum host_buffer_use use, VkDeviceSize size,
                      const char *name, struct glint_error *err);
void host_buffer_finish(struct host_buffer *buffer, struct gpu *gpu);

/* descriptors.c. A pool for sets with so many images of each kind, and the frame's buffers; a set with a name; one of its bindings:
   an image, or the texels of a buffer; a buffer. */
bool descriptors_create(struct gpu *gpu, uint32_t sets, uint32_t images, VkDescriptorPool *pool,
                        struct glint_error *err);
bool descriptors_allocate(struct gpu *gpu, VkDescriptorPool pool, const VkDescriptorSetLayout *layout, const char *name,
                          VkDescriptorSet *set, struct glint_error *err);
void descriptor_set_image(struct gpu *gpu, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                          VkImageView view, VkBufferView buffer);
void descriptor_set_buffer(struct gpu *gpu, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                           const struct host_buffer *buffer, VkDeviceSize size);

#endif
