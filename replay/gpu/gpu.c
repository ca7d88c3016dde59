/* Chooses and creates the Vulkan device, allocates memory and submits the command buffer. */
#define _GNU_SOURCE /* strcasestr */
#include "gpu.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The index of the chosen device, or `count` with an error that says why each candidate was rejected. */
static size_t choose_device(const struct glint_device_info *infos, size_t count, const char *select,
                            struct glint_error *err) {
    char why[768] = "";
    char *end = NULL;
    unsigned long index = select ? strtoul(select, &end, 10) : 0;
    bool by_index = select && isdigit((unsigned char)select[0]) && *end == 0;
    for (size_t i = 0; i < count; i++) {
        if (by_index ? i != index : select && !strcasestr(infos[i].name, select)) continue;
        if (infos[i].usable) return i;
        size_t used = strlen(why);
        snprintf(why + used, sizeof why - used, "; device %zu, %.120s, %.120s", i, infos[i].name, infos[i].reason);
    }
    if (count == 0) vk_fail_no_driver(err);
    else if (why[0]) glint_fail(err, GLINT_ERROR_UNSUPPORTED, "no usable Vulkan device%s", why);
    else
        glint_fail(err, GLINT_ERROR_USAGE, "no device matches '%s' among %zu; `glint devices` lists them", select,
                   count);
    return count;
}

static bool create_logical(struct gpu *gpu, struct glint_error *err) {
    uint32_t bits = 0;
    gpu->family = device_family(gpu->physical, &bits);
    gpu->timestamp_mask = bits >= 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(gpu->physical, &properties);
    gpu->timestamp_ns = (double)properties.limits.timestampPeriod;
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = gpu->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan13Features f13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                            .synchronization2 = VK_TRUE,
                                            .maintenance4 = VK_TRUE};
    VkPhysicalDeviceFeatures2 features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
        .pNext = &f13,
        .features = {.imageCubeArray = VK_TRUE, .shaderStorageImageWriteWithoutFormat = VK_TRUE}};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue};
    if (!vk_ok(vkCreateDevice(gpu->physical, &info, NULL, &gpu->device), "creating the device", err)) return false;
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    return true;
}

static bool create_commands(struct gpu *gpu, struct glint_error *err) {
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                          .queueFamilyIndex = gpu->family};
    if (!gpu_ok(gpu, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->pool), "creating the command pool", err))
        return false;
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = gpu->pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    if (!gpu_ok(gpu, vkAllocateCommandBuffers(gpu->device, &commands, &gpu->commands), "allocating the command buffer",
                err))
        return false;
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    if (!gpu_ok(gpu, vkCreateFence(gpu->device, &fence, NULL, &gpu->fence), "creating the fence", err)) return false;
    const VkPipelineCacheCreateInfo cache = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    if (!gpu_ok(gpu, vkCreatePipelineCache(gpu->device, &cache, NULL, &gpu->cache), "creating the pipeline cache", err))
        return false;
    return true;
}

static void load_debug_names(struct gpu *gpu) {
    if (!gpu->instance.debug_utils) return;
    VkInstance instance = gpu->instance.instance;
    gpu->debug.name = (PFN_vkSetDebugUtilsObjectNameEXT)(void (*)(void))vkGetInstanceProcAddr(
        instance, "vkSetDebugUtilsObjectNameEXT");
    gpu->debug.begin = (PFN_vkCmdBeginDebugUtilsLabelEXT)(void (*)(void))vkGetInstanceProcAddr(
        instance, "vkCmdBeginDebugUtilsLabelEXT");
    gpu->debug.end =
        (PFN_vkCmdEndDebugUtilsLabelEXT)(void (*)(void))vkGetInstanceProcAddr(instance, "vkCmdEndDebugUtilsLabelEXT");
}

bool gpu_init(struct gpu *gpu, const char *select, bool validate, struct glint_error *err) {
    VkPhysicalDevice *physical = NULL;
    struct glint_device_info *infos = NULL;
    size_t count = 0;
    *gpu = (struct gpu){0};
    pthread_mutex_init(&gpu->messages.lock, NULL);
    bool ok = instance_init(&gpu->instance, validate ? &gpu->messages : NULL, err) &&
              instance_devices(gpu->instance.instance, &physical, &infos, &count, err);
    const size_t chosen = ok ? choose_device(infos, count, select, err) : count;
    ok = ok && chosen < count;
    if (ok) {
        gpu->physical = physical[chosen];
        gpu->info = infos[chosen];
        ok = create_logical(gpu, err);
    }
    if (ok) load_debug_names(gpu);
    ok = ok && create_commands(gpu, err);
    free(physical);
    free(infos);
    if (!ok) return gpu_finish(gpu), false;
    device_set_name(gpu, VK_OBJECT_TYPE_QUEUE, (uint64_t)(uintptr_t)gpu->queue, "glint queue");
    device_set_name(gpu, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)(uintptr_t)gpu->commands, "glint commands");
    return true;
}

void gpu_wait(struct gpu *gpu) {
    if (gpu->device && vkDeviceWaitIdle(gpu->device) == VK_ERROR_DEVICE_LOST) gpu->lost = true;
}

void gpu_finish(struct gpu *gpu) {
    gpu_wait(gpu);
    if (gpu->device) {
        vkDestroyPipelineCache(gpu->device, gpu->cache, NULL);
        vkDestroyFence(gpu->device, gpu->fence, NULL);
        vkDestroyCommandPool(gpu->device, gpu->pool, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    instance_finish(&gpu->instance);
    pthread_mutex_destroy(&gpu->messages.lock);
    *gpu = (struct gpu){0};
}

bool device_allocate(struct gpu *gpu, const VkMemoryRequirements *need, VkMemoryPropertyFlags required,
                     VkMemoryPropertyFlags preferred, const char *name, VkDeviceMemory *memory,
                     struct glint_error *err) {
    const VkMemoryPropertyFlags tries[] = {required | preferred, required};
    for (size_t t = 0; t < 2; t++)
        for (uint32_t i = 0; i < gpu->memory.memoryTypeCount; i++) {
            if (!(need->memoryTypeBits & (1u << i)) ||
                (gpu->memory.memoryTypes[i].propertyFlags & tries[t]) != tries[t])
                continue;
            const VkMemoryAllocateInfo info = {
                .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = need->size, .memoryTypeIndex = i};
            VkResult result = vkAllocateMemory(gpu->device, &info, NULL, memory);
            if (result != VK_SUCCESS) {
                char what[256];
                snprintf(what, sizeof what, "allocating %llu bytes for %s", (unsigned long long)need->size, name);
                return gpu_fail(gpu, err, what, result);
            }
            device_set_name(gpu, VK_OBJECT_TYPE_DEVICE_MEMORY, (uint64_t)(uintptr_t)*memory, name);
            return true;
        }
    return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "the device has no memory of the kind that %s needs", name);
}

bool device_begin(struct gpu *gpu, struct glint_error *err) {
    if (!gpu_ok(gpu, vkResetCommandPool(gpu->device, gpu->pool, 0), "resetting the command pool", err)) return false;
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    return gpu_ok(gpu, vkBeginCommandBuffer(gpu->commands, &info), "beginning commands", err);
}

bool device_submit(struct gpu *gpu, const char *what, struct glint_error *err) {
    if (!gpu_ok(gpu, vkEndCommandBuffer(gpu->commands), what, err)) return false;
    const VkCommandBufferSubmitInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                .commandBuffer = gpu->commands};
    const VkSubmitInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &commands};
    if (!gpu_ok(gpu, vkResetFences(gpu->device, 1, &gpu->fence), what, err) ||
        !gpu_ok(gpu, vkQueueSubmit2(gpu->queue, 1, &info, gpu->fence), what, err))
        return false;
    const VkResult result = vkWaitForFences(gpu->device, 1, &gpu->fence, VK_TRUE, UINT64_MAX);
    if (result != VK_SUCCESS) gpu_wait(gpu); /* the commands may still execute */
    return gpu_ok(gpu, result, what, err);
}

void device_set_name(struct gpu *gpu, VkObjectType type, uint64_t handle, const char *name) {
    const VkDebugUtilsObjectNameInfoEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                .objectType = type,
                                                .objectHandle = handle,
                                                .pObjectName = name};
    if (gpu->debug.name) gpu->debug.name(gpu->device, &info);
}

void device_begin_label(struct gpu *gpu, const char *text) {
    const VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = text};
    if (gpu->debug.begin) gpu->debug.begin(gpu->commands, &label);
}

void device_end_label(struct gpu *gpu) {
    if (gpu->debug.end) gpu->debug.end(gpu->commands);
}

bool host_buffer_init(struct host_buffer *buffer, struct gpu *gpu, enum host_buffer_use use, VkDeviceSize size,
                      const char *name, struct glint_error *err) {
    static const VkBufferUsageFlags usage[] = {
        [HOST_BUFFER_UPLOAD] = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
        [HOST_BUFFER_READBACK] = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
        [HOST_BUFFER_UNIFORM] = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
        [HOST_BUFFER_STORAGE] = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
    };
    *buffer = (struct host_buffer){.size = size};
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage[use]};
    if (!gpu_ok(gpu, vkCreateBuffer(gpu->device, &info, NULL, &buffer->buffer), "creating a buffer", err)) {
        *buffer = (struct host_buffer){0};
        return false;
    }
    device_set_name(gpu, VK_OBJECT_TYPE_BUFFER, (uint64_t)(uintptr_t)buffer->buffer, name);
    VkMemoryRequirements need;
    vkGetBufferMemoryRequirements(gpu->device, buffer->buffer, &need);
    const VkMemoryPropertyFlags coherent = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    /* The host reads uncached memory slowly, and shaders read host memory slowly over the bus. */
    const VkMemoryPropertyFlags preferred = use == HOST_BUFFER_READBACK || use == HOST_BUFFER_STORAGE
                                                ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT
                                            : use == HOST_BUFFER_UPLOAD ? 0
                                                                        : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (device_allocate(gpu, &need, coherent, preferred, name, &buffer->memory, err) &&
        gpu_ok(gpu, vkBindBufferMemory(gpu->device, buffer->buffer, buffer->memory, 0), "binding a buffer", err) &&
        gpu_ok(gpu, vkMapMemory(gpu->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->map), "mapping a buffer",
               err))
        return true;
    host_buffer_finish(buffer, gpu);
    return false;
}

void host_buffer_finish(struct host_buffer *buffer, struct gpu *gpu) {
    vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
    vkFreeMemory(gpu->device, buffer->memory, NULL);
    *buffer = (struct host_buffer){0};
}
