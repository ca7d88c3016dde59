/* Choice and creation of the device, its memory and its one command buffer. */
#include "device.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool contains(const char *text, const char *part) {
    size_t length = strlen(part);
    for (; *text; text++) {
        size_t i = 0;
        while (i < length && text[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i])) i++;
        if (i == length) return true;
    }
    return length == 0;
}

/* The place of the chosen device, or `count` with an error that says why each one was passed over. */
static size_t choose(const struct glint_device_info *infos, size_t count, const char *select, struct glint_error *err) {
    char why[768] = "";
    char *end = NULL;
    unsigned long index = select ? strtoul(select, &end, 10) : 0;
    bool by_index = select && isdigit((unsigned char)select[0]) && *end == 0;
    for (size_t i = 0; i < count; i++) {
        if (by_index ? i != index : select && !contains(infos[i].name, select)) continue;
        if (infos[i].usable) return i;
        size_t used = strlen(why);
        snprintf(why + used, sizeof why - used, "; device %zu, %.120s, %.120s", i, infos[i].name, infos[i].reason);
    }
    if (count == 0)
        glint_fail(err, GLINT_ERROR_UNSUPPORTED,
                   "no Vulkan device found (Debian: mesa-vulkan-drivers, which needs no GPU)");
    else if (why[0]) glint_fail(err, GLINT_ERROR_UNSUPPORTED, "no usable Vulkan device%s", why);
    else
        glint_fail(err, GLINT_ERROR_USAGE, "no device matches '%s' among %zu; `glint devices` lists them", select,
                   count);
    return count;
}

static bool create_logical(struct glint_device *device, struct glint_error *err) {
    uint32_t bits = 0;
    device->family = device_family(device->physical, &bits);
    device->timestamp_mask = bits >= 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device->physical, &properties);
    device->timestamp_ns = (double)properties.limits.timestampPeriod;
    vkGetPhysicalDeviceMemoryProperties(device->physical, &device->memory);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = device->family,
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
    VkResult result = vkCreateDevice(device->physical, &info, NULL, &device->device);
    if (result != VK_SUCCESS) return vk_fail(err, "creating the device", result);
    vkGetDeviceQueue(device->device, device->family, 0, &device->queue);
    return true;
}

static bool create_commands(struct glint_device *device, struct glint_error *err) {
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                          .queueFamilyIndex = device->family};
    VkResult result = vkCreateCommandPool(device->device, &pool, NULL, &device->pool);
    if (result != VK_SUCCESS) return vk_fail(err, "creating the command pool", result);
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = device->pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    result = vkAllocateCommandBuffers(device->device, &commands, &device->commands);
    if (result != VK_SUCCESS) return vk_fail(err, "allocating the command buffer", result);
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    result = vkCreateFence(device->device, &fence, NULL, &device->fence);
    if (result != VK_SUCCESS) return vk_fail(err, "creating the fence", result);
    const VkPipelineCacheCreateInfo cache = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    result = vkCreatePipelineCache(device->device, &cache, NULL, &device->cache);
    if (result != VK_SUCCESS) return vk_fail(err, "creating the pipeline cache", result);
    return true;
}

static void load_debug_names(struct glint_device *device) {
    if (!device->instance.debug_utils) return;
    VkInstance instance = device->instance.instance;
    device->debug.name = (PFN_vkSetDebugUtilsObjectNameEXT)(void (*)(void))vkGetInstanceProcAddr(
        instance, "vkSetDebugUtilsObjectNameEXT");
    device->debug.begin = (PFN_vkCmdBeginDebugUtilsLabelEXT)(void (*)(void))vkGetInstanceProcAddr(
        instance, "vkCmdBeginDebugUtilsLabelEXT");
    device->debug.end =
        (PFN_vkCmdEndDebugUtilsLabelEXT)(void (*)(void))vkGetInstanceProcAddr(instance, "vkCmdEndDebugUtilsLabelEXT");
}

struct glint_device *glint_device_create(const struct glint_device_options *options, struct glint_error *err) {
    struct glint_device *device = calloc(1, sizeof *device);
    VkPhysicalDevice *physical = NULL;
    struct glint_device_info *infos = NULL;
    size_t count = 0;
    bool done = false;
    if (!device) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    pthread_mutex_init(&device->messages.lock, NULL);
    const char *select = options && options->select ? options->select : getenv("GLINT_DEVICE");
    if (select && !select[0]) select = NULL;
    const char *validation = getenv("GLINT_VALIDATION");
    bool validate = (options && options->validation) || (validation && strcmp(validation, "1") == 0);
    const char *passes = options && options->passes ? options->passes : getenv("GLINT_PASSES");
    if (!shaders_init(&device->shaders, passes, err)) goto done;
    if (!instance_init(&device->instance, validate ? &device->messages : NULL, err)) goto done;
    if (!instance_devices(device->instance.instance, &physical, &infos, &count, err)) goto done;
    size_t chosen = choose(infos, count, select, err);
    if (chosen == count) goto done;
    device->physical = physical[chosen];
    device->info = infos[chosen];
    if (!create_logical(device, err)) goto done;
    load_debug_names(device);
    if (!create_commands(device, err)) goto done;
    device_set_name(device, VK_OBJECT_TYPE_QUEUE, (uint64_t)(uintptr_t)device->queue, "glint queue");
    device_set_name(device, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)(uintptr_t)device->commands, "glint commands");
    done = true;
done:
    free(physical);
    free(infos);
    if (!done) glint_device_destroy(&device);
    return device;
}

void glint_device_destroy(struct glint_device **pointer) {
    struct glint_device *device = *pointer;
    *pointer = NULL;
    if (!device) return;
    if (device->device) {
        vkDeviceWaitIdle(device->device);
        if (device->programs) device->finish_programs(device);
        vkDestroyPipelineCache(device->device, device->cache, NULL);
        vkDestroyFence(device->device, device->fence, NULL);
        vkDestroyCommandPool(device->device, device->pool, NULL);
        vkDestroyDevice(device->device, NULL);
    }
    instance_finish(&device->instance);
    shaders_finish(&device->shaders);
    pthread_mutex_destroy(&device->messages.lock);
    free(device);
}

const struct glint_device_info *glint_device_get_info(const struct glint_device *device) {
    return &device->info;
}

uint32_t glint_device_messages(const struct glint_device *device, const char **last) {
    if (last) *last = device->messages.last;
    return device->messages.count;
}

bool device_allocate(struct glint_device *device, const VkMemoryRequirements *need, VkMemoryPropertyFlags wanted,
                     VkMemoryPropertyFlags preferred, const char *name, VkDeviceMemory *memory,
                     struct glint_error *err) {
    const VkMemoryPropertyFlags tries[] = {wanted | preferred, wanted};
    for (size_t t = 0; t < 2; t++)
        for (uint32_t i = 0; i < device->memory.memoryTypeCount; i++) {
            if (!(need->memoryTypeBits & (1u << i)) ||
                (device->memory.memoryTypes[i].propertyFlags & tries[t]) != tries[t])
                continue;
            const VkMemoryAllocateInfo info = {
                .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = need->size, .memoryTypeIndex = i};
            VkResult result = vkAllocateMemory(device->device, &info, NULL, memory);
            if (result != VK_SUCCESS) {
                char what[256];
                snprintf(what, sizeof what, "allocating %llu bytes for %s", (unsigned long long)need->size, name);
                return vk_fail(err, what, result);
            }
            device_set_name(device, VK_OBJECT_TYPE_DEVICE_MEMORY, (uint64_t)(uintptr_t)*memory, name);
            return true;
        }
    return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "the device has no memory of the kind that %s needs", name);
}

bool device_begin(struct glint_device *device, struct glint_error *err) {
    VkResult result = vkResetCommandPool(device->device, device->pool, 0);
    if (result != VK_SUCCESS) return vk_fail(err, "resetting the command pool", result);
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    result = vkBeginCommandBuffer(device->commands, &info);
    return result == VK_SUCCESS || vk_fail(err, "beginning commands", result);
}

bool device_submit(struct glint_device *device, const char *what, struct glint_error *err) {
    VkResult result = vkEndCommandBuffer(device->commands);
    if (result != VK_SUCCESS) return vk_fail(err, what, result);
    const VkCommandBufferSubmitInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                .commandBuffer = device->commands};
    const VkSubmitInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &commands};
    result = vkQueueSubmit2(device->queue, 1, &info, device->fence);
    if (result != VK_SUCCESS) return vk_fail(err, what, result);
    result = vkWaitForFences(device->device, 1, &device->fence, VK_TRUE, UINT64_MAX);
    if (result != VK_SUCCESS) return vk_fail(err, what, result);
    vkResetFences(device->device, 1, &device->fence);
    return true;
}

void device_set_name(struct glint_device *device, VkObjectType type, uint64_t handle, const char *name) {
    const VkDebugUtilsObjectNameInfoEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                .objectType = type,
                                                .objectHandle = handle,
                                                .pObjectName = name};
    if (device->debug.name) device->debug.name(device->device, &info);
}

void device_begin_label(struct glint_device *device, const char *text) {
    const VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = text};
    if (device->debug.begin) device->debug.begin(device->commands, &label);
}

void device_end_label(struct glint_device *device) {
    if (device->debug.end) device->debug.end(device->commands);
}

bool host_buffer_init(struct host_buffer *buffer, struct glint_device *device, enum host_buffer_use use,
                      VkDeviceSize size, const char *name, struct glint_error *err) {
    static const VkBufferUsageFlags usage[] = {
        [HOST_BUFFER_UPLOAD] = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
        [HOST_BUFFER_READBACK] = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
        [HOST_BUFFER_UNIFORM] = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
        [HOST_BUFFER_STORAGE] = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
    };
    *buffer = (struct host_buffer){.size = size};
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage[use]};
    VkResult result = vkCreateBuffer(device->device, &info, NULL, &buffer->buffer);
    if (result != VK_SUCCESS) return vk_fail(err, "creating a buffer", result);
    device_set_name(device, VK_OBJECT_TYPE_BUFFER, (uint64_t)(uintptr_t)buffer->buffer, name);
    VkMemoryRequirements need;
    vkGetBufferMemoryRequirements(device->device, buffer->buffer, &need);
    const VkMemoryPropertyFlags coherent = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    /* Reading uncached memory is slow for the host; what shaders read over the bus is slow for every pass. */
    const VkMemoryPropertyFlags preferred = use == HOST_BUFFER_READBACK || use == HOST_BUFFER_STORAGE
                                                ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT
                                            : use == HOST_BUFFER_UPLOAD ? 0
                                                                        : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (!device_allocate(device, &need, coherent, preferred, name, &buffer->memory, err)) goto fail;
    result = vkBindBufferMemory(device->device, buffer->buffer, buffer->memory, 0);
    if (result == VK_SUCCESS) result = vkMapMemory(device->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->map);
    if (result == VK_SUCCESS) return true;
    vk_fail(err, "mapping a buffer", result);
fail:
    host_buffer_finish(buffer, device);
    return false;
}

void host_buffer_finish(struct host_buffer *buffer, struct glint_device *device) {
    vkDestroyBuffer(device->device, buffer->buffer, NULL);
    vkFreeMemory(device->device, buffer->memory, NULL);
    *buffer = (struct host_buffer){0};
}
