/* Chooses and creates the Vulkan device, allocates memory and submits the command buffer. */
#define _GNU_SOURCE /* strcasestr */
#include "gpu.h"

#include <ctype.h>
#include <stdatomic.h>
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

/* What keeps shaders from memory outside of their buffers and images, as far as the device has it. Chained after `f13`. */
static bool find_robustness(const struct gpu *gpu, VkPhysicalDeviceFeatures *features,
                            VkPhysicalDeviceVulkan13Features *f13, VkPhysicalDeviceRobustness2FeaturesEXT *two) {
    VkPhysicalDeviceRobustness2FeaturesEXT has2 = {.sType =
                                                       VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT};
    VkPhysicalDeviceVulkan13Features has13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures2 has = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &has13};
    const bool extension = device_has_extension(gpu->physical, VK_EXT_ROBUSTNESS_2_EXTENSION_NAME);
    if (extension) has13.pNext = &has2;
    vkGetPhysicalDeviceFeatures2(gpu->physical, &has);
    features->robustBufferAccess = has.features.robustBufferAccess;
    f13->robustImageAccess = has13.robustImageAccess;
    two->robustBufferAccess2 = has2.robustBufferAccess2 && has.features.robustBufferAccess;
    two->robustImageAccess2 = has2.robustImageAccess2;
    if (extension) f13->pNext = two;
    return extension;
}

static bool create_logical(struct gpu *gpu, struct glint_error *err) {
    uint32_t bits = 0;
    gpu->family = device_family(gpu->physical, &bits);
    gpu->timestamp_mask = bits >= 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(gpu->physical, &properties);
    gpu->limits = properties.limits;
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
    VkPhysicalDeviceRobustness2FeaturesEXT two = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT};
    static const char *const extensions[] = {VK_EXT_ROBUSTNESS_2_EXTENSION_NAME};
    const bool extended = find_robustness(gpu, &features.features, &f13, &two);
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = extended,
                                     .ppEnabledExtensionNames = extensions};
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

/* The driver of a GPU usually ends what takes longer than some seconds by itself. A CPU that is shared with other programs may need minutes for a
   pass over a large frame. */
static double usual_pass_limit_s(const struct glint_device_info *info) {
    return info->is_cpu ? 600 : 60;
}

bool gpu_init(struct gpu *gpu, const char *select, bool validate, uint32_t pass_limit_s, struct glint_error *err) {
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
        gpu->pass_limit_s = pass_limit_s ? pass_limit_s : usual_pass_limit_s(&gpu->info);
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

static atomic_bool gave_up;

void gpu_give_up(struct gpu *gpu) {
    gpu->lost = gpu->given_up = true;
    atomic_store(&gave_up, true);
}

bool gpu_gave_up(void) {
    return atomic_load(&gave_up);
}

void gpu_wait(struct gpu *gpu) {
    if (gpu->device && !gpu->given_up && vkDeviceWaitIdle(gpu->device) == VK_ERROR_DEVICE_LOST) gpu->lost = true;
}

void gpu_finish(struct gpu *gpu) {
    gpu_wait(gpu);
    if (gpu->device) {
        GPU_DESTROY(gpu, vkDestroyPipelineCache, gpu->cache);
        GPU_DESTROY(gpu, vkDestroyFence, gpu->fence);
        GPU_DESTROY(gpu, vkDestroyCommandPool, gpu->pool);
        if (!gpu->given_up) vkDestroyDevice(gpu->device, NULL);
    }
    if (!gpu->given_up) instance_finish(&gpu->instance);
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
    if (gpu->given_up) return gpu_fail(gpu, err, "beginning commands", VK_ERROR_DEVICE_LOST);
    if (!gpu_ok(gpu, vkResetCommandPool(gpu->device, gpu->pool, 0), "resetting the command pool", err)) return false;
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    return gpu_ok(gpu, vkBeginCommandBuffer(gpu->commands, &info), "beginning commands", err);
}

/* Waits a second at a time, so that the time in which the process was stopped does not count. */
static VkResult wait_within(const struct gpu *gpu, double limit_s) {
    const uint64_t second_ns = 1000000000;
    VkResult result = VK_TIMEOUT;
    for (double waited_s = 0; result == VK_TIMEOUT && waited_s < limit_s; waited_s++)
        result = vkWaitForFences(gpu->device, 1, &gpu->fence, VK_TRUE, second_ns);
    return result;
}

bool device_submit(struct gpu *gpu, const char *what, uint32_t passes, struct glint_error *err) {
    if (!gpu_ok(gpu, vkEndCommandBuffer(gpu->commands), what, err)) return false;
    const VkCommandBufferSubmitInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                .commandBuffer = gpu->commands};
    const VkSubmitInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &commands};
    if (!gpu_ok(gpu, vkResetFences(gpu->device, 1, &gpu->fence), what, err) ||
        !gpu_ok(gpu, vkQueueSubmit2(gpu->queue, 1, &info, gpu->fence), what, err))
        return false;
    const double limit_s = gpu->pass_limit_s * (passes ? passes : 1);
    const VkResult result = wait_within(gpu, limit_s);
    if (result == VK_TIMEOUT) {
        gpu_give_up(gpu);
        return glint_fail(err, GLINT_ERROR_DEVICE,
                          "Vulkan: %s: not done within %.0f s, so the device was given up; --dispatch-limit or "
                          "$GLINT_DISPATCH_LIMIT allows a pass more than %.0f s",
                          what, limit_s, gpu->pass_limit_s);
    }
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
    GPU_DESTROY(gpu, vkDestroyBuffer, buffer->buffer);
    GPU_DESTROY(gpu, vkFreeMemory, buffer->memory);
    *buffer = (struct host_buffer){0};
}
