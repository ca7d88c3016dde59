/* A Vulkan layer that hides from programs what a device has, for tests of what glint does without it. GLINT_HIDE names one thing:

   STRUCT:N        the N-th feature, from 0, of VkPhysicalDeviceFeatures, VkPhysicalDeviceVulkan11Features to …13Features, or VkPhysicalDeviceRobustness2FeaturesEXT
   extension:NAME  a device extension
   format:N        that images of the VkFormat N can be sampled, stored and copied
   limit:NAME      what a limit has above what Vulkan requires of every device
   timestamps      those of all queues

   A device that is created with a hidden feature or extension is none, as a driver's would be. A descriptor set layout above a lowered limit is told on stderr. */
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

static PFN_vkGetInstanceProcAddr next_instance;
static PFN_vkGetDeviceProcAddr next_device;
static VkInstance instance; /* the last one: programs that are tested use one at a time */

/* Functions of the layer below, which has to be asked for them while an instance is created. */
/* clang-format off */
#define NEXT_FUNCTIONS \
    NEXT(GetPhysicalDeviceFeatures2) \
    NEXT(EnumerateDeviceExtensionProperties) \
    NEXT(GetPhysicalDeviceProperties) \
    NEXT(GetPhysicalDeviceProperties2) \
    NEXT(GetPhysicalDeviceFormatProperties) \
    NEXT(GetPhysicalDeviceQueueFamilyProperties)
/* clang-format on */
#define NEXT(name) static PFN_vk##name next_##name;
NEXT_FUNCTIONS
#undef NEXT

/* What follows "KIND:" if that is hidden, else NULL. */
static const char *hidden(const char *kind) {
    const char *text = getenv("GLINT_HIDE");
    const size_t length = strlen(kind);
    return text && !strncmp(text, kind, length) && text[length] == ':' ? text + length + 1 : NULL;
}

/* ---- Features ---- */

/* Structures of features that the tests hide, by the offset of their first one. */
static const struct {
    VkStructureType type;
    const char *name;
    size_t first;
} kinds[] = {
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, "VkPhysicalDeviceFeatures",
     offsetof(VkPhysicalDeviceFeatures2, features)},
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, "VkPhysicalDeviceVulkan11Features",
     offsetof(VkPhysicalDeviceVulkan11Features, storageBuffer16BitAccess)},
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, "VkPhysicalDeviceVulkan12Features",
     offsetof(VkPhysicalDeviceVulkan12Features, samplerMirrorClampToEdge)},
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, "VkPhysicalDeviceVulkan13Features",
     offsetof(VkPhysicalDeviceVulkan13Features, robustImageAccess)},
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT, "VkPhysicalDeviceRobustness2FeaturesEXT",
     offsetof(VkPhysicalDeviceRobustness2FeaturesEXT, robustBufferAccess2)},
};

/* The hidden feature in a chain of structures, or NULL. */
static VkBool32 *hidden_feature(const void *chain) {
    for (const VkBaseInStructure *s = chain; s; s = s->pNext)
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            const char *number = s->sType == kinds[k].type ? hidden(kinds[k].name) : NULL;
            if (number) return (VkBool32 *)((char *)(uintptr_t)s + kinds[k].first) + strtoul(number, NULL, 10);
        }
    return NULL;
}

static VKAPI_ATTR void VKAPI_CALL hide_GetPhysicalDeviceFeatures2(VkPhysicalDevice device,
                                                                  VkPhysicalDeviceFeatures2 *features) {
    next_GetPhysicalDeviceFeatures2(device, features);
    VkBool32 *feature = hidden_feature(features);
    if (feature) *feature = VK_FALSE;
}

static VKAPI_ATTR VkResult VKAPI_CALL hide_EnumerateDeviceExtensionProperties(VkPhysicalDevice device,
                                                                              const char *layer, uint32_t *count,
                                                                              VkExtensionProperties *list) {
    const VkResult result = next_EnumerateDeviceExtensionProperties(device, layer, count, list);
    const char *name = hidden("extension");
    for (uint32_t i = 0; name && list && i < *count; i++)
        if (!strcmp(list[i].extensionName, name)) list[i] = list[--*count];
    return result;
}

/* ---- Limits, formats and queues ---- */

/* LIMIT(name, what Vulkan requires) */
/* clang-format off */
#define LIMITS \
    LIMIT(maxImageDimension2D, 4096) \
    LIMIT(maxImageDimensionCube, 4096) \
    LIMIT(maxImageArrayLayers, 256) \
    LIMIT(maxTexelBufferElements, 65536) \
    LIMIT(maxUniformBufferRange, 16384) \
    LIMIT(maxStorageBufferRange, 1 << 27) \
    LIMIT(maxPushConstantsSize, 128) \
    LIMIT(maxMemoryAllocationCount, 4096) \
    LIMIT(maxSamplerAllocationCount, 4000) \
    LIMIT(maxBoundDescriptorSets, 4) \
    LIMIT(maxPerStageDescriptorSamplers, 16) \
    LIMIT(maxPerStageDescriptorUniformBuffers, 12) \
    LIMIT(maxPerStageDescriptorStorageBuffers, 4) \
    LIMIT(maxPerStageDescriptorSampledImages, 16) \
    LIMIT(maxPerStageDescriptorStorageImages, 4) \
    LIMIT(maxPerStageResources, 128) \
    LIMIT(maxComputeSharedMemorySize, 16384) \
    LIMIT(maxComputeWorkGroupInvocations, 128)
/* clang-format on */

static void lower(VkPhysicalDeviceLimits *limits) {
    const char *name = hidden("limit");
#define LIMIT(limit, required)                                                                                         \
    if (name && !strcmp(name, #limit)) limits->limit = required;
    LIMITS
#undef LIMIT
}

static VKAPI_ATTR void VKAPI_CALL hide_GetPhysicalDeviceProperties(VkPhysicalDevice device,
                                                                   VkPhysicalDeviceProperties *properties) {
    next_GetPhysicalDeviceProperties(device, properties);
    lower(&properties->limits);
}

static VKAPI_ATTR void VKAPI_CALL hide_GetPhysicalDeviceProperties2(VkPhysicalDevice device,
                                                                    VkPhysicalDeviceProperties2 *properties) {
    next_GetPhysicalDeviceProperties2(device, properties);
    lower(&properties->properties.limits);
}

static VKAPI_ATTR void VKAPI_CALL hide_GetPhysicalDeviceFormatProperties(VkPhysicalDevice device, VkFormat format,
                                                                         VkFormatProperties *properties) {
    const char *number = hidden("format");
    next_GetPhysicalDeviceFormatProperties(device, format, properties);
    if (number && strtoul(number, NULL, 10) == (unsigned long)format) *properties = (VkFormatProperties){0};
}

static VKAPI_ATTR void VKAPI_CALL hide_GetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice device, uint32_t *count,
                                                                              VkQueueFamilyProperties *families) {
    const char *text = getenv("GLINT_HIDE");
    next_GetPhysicalDeviceQueueFamilyProperties(device, count, families);
    for (uint32_t i = 0; text && !strcmp(text, "timestamps") && families && i < *count; i++)
        families[i].timestampValidBits = 0;
}

/* Counts the images of a layout; a driver would not. */
static VKAPI_ATTR VkResult VKAPI_CALL hide_CreateDescriptorSetLayout(VkDevice device,
                                                                     const VkDescriptorSetLayoutCreateInfo *info,
                                                                     const VkAllocationCallbacks *allocator,
                                                                     VkDescriptorSetLayout *layout) {
    const char *name = hidden("limit");
    uint32_t sampled = 0, stored = 0;
    for (uint32_t i = 0; i < info->bindingCount; i++) {
        const VkDescriptorType type = info->pBindings[i].descriptorType;
        sampled += type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        stored += type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE || type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    }
    if (name && ((!strcmp(name, "maxPerStageDescriptorSampledImages") && sampled > 16) ||
                 (!strcmp(name, "maxPerStageDescriptorStorageImages") && stored > 4)))
        fprintf(stderr, "hide layer: %u sampled and %u stored images, above the limit %s\n", sampled, stored, name);
    return ((PFN_vkCreateDescriptorSetLayout)next_device(device, "vkCreateDescriptorSetLayout"))(device, info,
                                                                                                 allocator, layout);
}

/* ---- Instances and devices ---- */

static VKAPI_ATTR VkResult VKAPI_CALL hide_CreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                                        const VkAllocationCallbacks *allocator, VkDevice *device) {
    VkLayerDeviceCreateInfo *link = (VkLayerDeviceCreateInfo *)(uintptr_t)info->pNext;
    while (link &&
           !(link->sType == VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO && link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerDeviceCreateInfo *)(uintptr_t)link->pNext;
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const VkBool32 *feature = hidden_feature(info->pNext);
    const char *extension = hidden("extension");
    if (feature && *feature) return VK_ERROR_FEATURE_NOT_PRESENT;
    for (uint32_t i = 0; extension && i < info->enabledExtensionCount; i++)
        if (!strcmp(info->ppEnabledExtensionNames[i], extension)) return VK_ERROR_EXTENSION_NOT_PRESENT;
    PFN_vkCreateDevice create =
        (PFN_vkCreateDevice)link->u.pLayerInfo->pfnNextGetInstanceProcAddr(instance, "vkCreateDevice");
    next_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    return create(physical, info, allocator, device);
}

static VKAPI_ATTR VkResult VKAPI_CALL hide_CreateInstance(const VkInstanceCreateInfo *info,
                                                          const VkAllocationCallbacks *allocator, VkInstance *made) {
    VkLayerInstanceCreateInfo *link = (VkLayerInstanceCreateInfo *)(uintptr_t)info->pNext;
    while (link &&
           !(link->sType == VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO && link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerInstanceCreateInfo *)(uintptr_t)link->pNext;
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    next_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = ((PFN_vkCreateInstance)next_instance(NULL, "vkCreateInstance"))(info, allocator, made);
    if (result) return result;
    instance = *made;
#define NEXT(name) next_##name = (PFN_vk##name)next_instance(instance, "vk" #name);
    NEXT_FUNCTIONS
#undef NEXT
    return VK_SUCCESS;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL hide_GetInstanceProcAddr(VkInstance of, const char *name);
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL hide_GetDeviceProcAddr(VkDevice device, const char *name);

static PFN_vkVoidFunction own_function(const char *name) {
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } own[] = {
#define OWN(name) {"vk" #name, (PFN_vkVoidFunction)hide_##name}
        OWN(CreateInstance),
        OWN(CreateDevice),
        OWN(GetInstanceProcAddr),
        OWN(GetDeviceProcAddr),
        OWN(GetPhysicalDeviceFeatures2),
        OWN(EnumerateDeviceExtensionProperties),
        OWN(GetPhysicalDeviceProperties),
        OWN(GetPhysicalDeviceProperties2),
        OWN(GetPhysicalDeviceFormatProperties),
        OWN(GetPhysicalDeviceQueueFamilyProperties),
        OWN(CreateDescriptorSetLayout),
    };
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (!strcmp(own[i].name, name)) return own[i].function;
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL hide_GetDeviceProcAddr(VkDevice device, const char *name) {
    if (!strcmp(name, "vkGetDeviceProcAddr") || !strcmp(name, "vkCreateDescriptorSetLayout")) return own_function(name);
    return next_device(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL hide_GetInstanceProcAddr(VkInstance of, const char *name) {
    const PFN_vkVoidFunction own = own_function(name);
    return own || !of ? own : next_instance(of, name);
}

VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *interface);

VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *interface) {
    if (interface->loaderLayerInterfaceVersion > 2) interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = hide_GetInstanceProcAddr;
    interface->pfnGetDeviceProcAddr = hide_GetDeviceProcAddr;
    interface->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
