/* The Vulkan device: memory, a single command buffer, object names. It is independent of passes. */
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
    VkPhysicalDeviceLimits limits;
    double timestamp_ns;     /* nanoseconds a tick */
    uint64_t timestamp_mask; /* 0: no timestamps */
    VkPhysicalDeviceMemoryProperties memory;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
    VkPipelineCache cache;
    double pass_limit_s; /* how long the device may execute a pass */
    bool lost;           /* a call has returned VK_ERROR_DEVICE_LOST, or the device was given up */
    bool given_up;       /* it has executed a pass for too long, and perhaps still does: nothing of it is destroyed */
    struct glint_device_info info;
};

/* Creates an instance; `messages` non-NULL switches validation on. */
bool instance_init(struct instance *instance, struct messages *messages, struct glint_error *err);
void instance_finish(struct instance *instance);
/* Devices of an instance, best first. The caller frees both arrays. */
bool instance_devices(VkInstance instance, VkPhysicalDevice **physical, struct glint_device_info **infos, size_t *count,
                      struct glint_error *err);
/* The queue family for compute and copies, one with timestamps if possible; UINT32_MAX if there is none. */
uint32_t device_family(VkPhysicalDevice physical, uint32_t *timestamp_bits);

bool device_has_extension(VkPhysicalDevice physical, const char *name);

/* Fails with a message that names the operation and the result. */
bool vk_fail_no_driver(struct glint_error *err);
bool vk_fail(struct glint_error *err, const char *what, VkResult result);
bool vk_ok(VkResult result, const char *what,
           struct glint_error *err); /* fails alike unless the result is VK_SUCCESS */
/* The same for calls of a device, which they may find lost. */
bool gpu_fail(struct gpu *gpu, struct glint_error *err, const char *what, VkResult result);
bool gpu_ok(struct gpu *gpu, VkResult result, const char *what, struct glint_error *err);
VkFormat format_vulkan(enum glint_format format);

/* `select` is that of struct glint_device_options; `validate` enables the validation layer; `pass_limit_s` 0: the usual one of such a device.
   The struct must not be moved afterwards. */
bool gpu_init(struct gpu *gpu, const char *select, bool validate, uint32_t pass_limit_s, struct glint_error *err);
void gpu_finish(struct gpu *gpu);
/* Destroys or frees an object by this function of Vulkan. What a device that was given up may still use is left to the end of the process. */
#define GPU_DESTROY(gpu, destroy, object) ((gpu)->given_up ? (void)0 : destroy((gpu)->device, object, NULL))
/* The device has not ended something within the limit; whether one of this process did not. */
void gpu_give_up(struct gpu *gpu);
bool gpu_gave_up(void);
/* Waits until the device is idle, or lost. */
void gpu_wait(struct gpu *gpu);

bool device_allocate(struct gpu *gpu, const VkMemoryRequirements *need, VkMemoryPropertyFlags required,
                     VkMemoryPropertyFlags preferred, const char *name, VkDeviceMemory *memory,
                     struct glint_error *err);

/* Begins the command buffer; submits it and waits for it. `what` is used in error messages, and each of the `passes` that were recorded has its
   time (0 counts as 1). Whatever they return, the device then executes nothing, so that what the commands used may be released; or it was given up. */
bool device_begin(struct gpu *gpu, struct glint_error *err);
bool device_submit(struct gpu *gpu, const char *what, uint32_t passes, struct glint_error *err);

void device_set_name(struct gpu *gpu, VkObjectType type, uint64_t handle, const char *name);
void device_begin_label(struct gpu *gpu, const char *text);
void device_end_label(struct gpu *gpu);

/* A buffer in memory that host and device can access, which stays mapped. */
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

/* descriptors.c: creates a pool for `sets` sets with at most `images` images of each kind and the buffers of the frame, with `values` also one
   with a dynamic offset; allocates a set; binds an image or texel buffer; binds a buffer. */
bool descriptors_create(struct gpu *gpu, uint32_t sets, uint32_t images, bool values, VkDescriptorPool *pool,
                        struct glint_error *err);
bool descriptors_allocate(struct gpu *gpu, VkDescriptorPool pool, const VkDescriptorSetLayout *layout, const char *name,
                          VkDescriptorSet *set, struct glint_error *err);
void descriptor_set_image(struct gpu *gpu, VkDescriptorSet set, uint32_t binding, uint32_t element,
                          VkDescriptorType type, VkImageView view, VkBufferView buffer);
void descriptor_set_buffer(struct gpu *gpu, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                           const struct host_buffer *buffer, VkDeviceSize size);

#endif
