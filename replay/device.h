/* The Vulkan device with what every module needs of it: memory, one command buffer at a time, object names. */
#ifndef GLINT_REPLAY_DEVICE_H
#define GLINT_REPLAY_DEVICE_H

#include <pthread.h>

#include <vulkan/vulkan.h>

#include "glint/replay.h"
#include "shader.h"

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

struct glint_device {
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
    struct shaders shaders;
    struct programs *programs; /* NULL until a replay wants some */
    void (*finish_programs)(struct glint_device *device);
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

bool device_allocate(struct glint_device *device, const VkMemoryRequirements *need, VkMemoryPropertyFlags wanted,
                     VkMemoryPropertyFlags preferred, const char *name, VkDeviceMemory *memory,
                     struct glint_error *err);

/* One command buffer at a time: begin, record, submit and wait. */
bool device_begin(struct glint_device *device, struct glint_error *err);
bool device_submit(struct glint_device *device, const char *what, struct glint_error *err);

void device_set_name(struct glint_device *device, VkObjectType type, uint64_t handle, const char *name);
void device_begin_label(struct glint_device *device, const char *text);
void device_end_label(struct glint_device *device);

/* Memory that host and device see, mapped for its whole life. */
struct host_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *map;
    VkDeviceSize size;
};
enum host_buffer_use { HOST_BUFFER_UPLOAD, HOST_BUFFER_READBACK, HOST_BUFFER_UNIFORM, HOST_BUFFER_STORAGE };
bool host_buffer_init(struct host_buffer *buffer, struct glint_device *device, enum host_buffer_use use,
                      VkDeviceSize size, const char *name, struct glint_error *err);
void host_buffer_finish(struct host_buffer *buffer, struct glint_device *device);

VkFormat format_vulkan(enum glint_format format);
uint32_t format_components(enum glint_format format);
size_t format_bytes(enum glint_format format); /* of one texel */
bool format_is_uint(enum glint_format format);
const char *format_name(enum glint_format format);
/* The same image with float in place of half. */
enum glint_format format_widened(enum glint_format format);

#endif
