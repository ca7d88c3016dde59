/* The Vulkan instance, its validation messages and the list of devices. */
#include "format.h"
#include "gpu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const validation_layer = "VK_LAYER_KHRONOS_validation";

static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                     VkDebugUtilsMessageTypeFlagsEXT types,
                                     const VkDebugUtilsMessengerCallbackDataEXT *data, void *user) {
    struct messages *messages = user;
    (void)severity, (void)types;
    pthread_mutex_lock(&messages->lock);
    messages->count++;
    snprintf(messages->last, sizeof messages->last, "%s", data->pMessage);
    pthread_mutex_unlock(&messages->lock);
    return VK_FALSE;
}

static bool has_layer(const char *name) {
    VkLayerProperties layers[64];
    uint32_t count = 64;
    vkEnumerateInstanceLayerProperties(&count, layers);
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(layers[i].layerName, name) == 0) return true;
    return false;
}

static bool has_extension(const char *layer, const char *name) {
    VkExtensionProperties extensions[128];
    uint32_t count = 128;
    vkEnumerateInstanceExtensionProperties(layer, &count, extensions);
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(extensions[i].extensionName, name) == 0) return true;
    return false;
}

bool instance_init(struct instance *instance, struct messages *messages, struct glint_error *err) {
    uint32_t version = VK_API_VERSION_1_0;
    vkEnumerateInstanceVersion(&version);
    if (version < VK_API_VERSION_1_3)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "the Vulkan loader offers %u.%u, expected 1.3 or later",
                          VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
    bool validate = messages != NULL;
    if (validate && !has_layer(validation_layer))
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED,
                          "validation was requested, but %s is not installed (Debian: vulkan-validationlayers)",
                          validation_layer);
    instance->debug_utils = has_extension(NULL, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkDebugUtilsMessengerCreateInfoEXT listener = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
                                                   .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                                                      VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
                                                   .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
                                                   .pfnUserCallback = on_message,
                                                   .pUserData = messages};
    const VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                              .pNext = &listener,
                                              .enabledValidationFeatureCount = 1,
                                              .pEnabledValidationFeatures = enables};
    const char *extensions[2];
    uint32_t extension_count = 0;
    if (instance->debug_utils) extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (validate) extensions[extension_count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "glint",
                                           .pEngineName = "glint",
                                           .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pNext = validate ? &features : NULL,
                                       .pApplicationInfo = &application,
                                       .enabledLayerCount = validate,
                                       .ppEnabledLayerNames = &validation_layer,
                                       .enabledExtensionCount = extension_count,
                                       .ppEnabledExtensionNames = extensions};
    if (!vk_ok(vkCreateInstance(&info, NULL, &instance->instance), "creating the instance", err)) return false;
    if (validate && instance->debug_utils) {
        PFN_vkCreateDebugUtilsMessengerEXT create =
            (PFN_vkCreateDebugUtilsMessengerEXT)(void (*)(void))vkGetInstanceProcAddr(instance->instance,
                                                                                      "vkCreateDebugUtilsMessengerEXT");
        if (create) create(instance->instance, &listener, NULL, &instance->messenger);
    }
    return true;
}

void instance_finish(struct instance *instance) {
    if (!instance->instance) return;
    PFN_vkDestroyDebugUtilsMessengerEXT destroy =
        (PFN_vkDestroyDebugUtilsMessengerEXT)(void (*)(void))vkGetInstanceProcAddr(instance->instance,
                                                                                   "vkDestroyDebugUtilsMessengerEXT");
    if (instance->messenger && destroy) destroy(instance->instance, instance->messenger, NULL);
    vkDestroyInstance(instance->instance, NULL);
    *instance = (struct instance){0};
}

uint32_t device_family(VkPhysicalDevice physical, uint32_t *timestamp_bits) {
    VkQueueFamilyProperties families[32];
    uint32_t count = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (int want_timestamps = 1; want_timestamps >= 0; want_timestamps--)
        for (uint32_t i = 0; i < count; i++)
            if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) &&
                (!want_timestamps || families[i].timestampValidBits)) {
                if (timestamp_bits) *timestamp_bits = families[i].timestampValidBits;
                return i;
            }
    return UINT32_MAX;
}

bool device_has_extension(VkPhysicalDevice physical, const char *name) {
    VkExtensionProperties extensions[512];
    uint32_t count = 512;
    bool found = false;
    vkEnumerateDeviceExtensionProperties(physical, NULL, &count, extensions);
    for (uint32_t i = 0; i < count; i++) found |= !strcmp(extensions[i].extensionName, name);
    return found;
}

/* False with the reason if the device lacks a feature that passes need. */
static bool check_usable(VkPhysicalDevice physical, uint32_t api_version, char *reason, size_t size) {
    if (api_version < VK_API_VERSION_1_3) {
        snprintf(reason, size, "offers Vulkan %u.%u, expected 1.3", VK_API_VERSION_MAJOR(api_version),
                 VK_API_VERSION_MINOR(api_version));
        return false;
    }
    VkPhysicalDeviceVulkan13Features f13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures2 f = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &f13};
    vkGetPhysicalDeviceFeatures2(physical, &f);
    const struct {
        VkBool32 has;
        const char *name;
    } required[] = {
        {f13.synchronization2, "synchronization2"},
        {f13.maintenance4, "maintenance4"},
        {f.features.shaderStorageImageWriteWithoutFormat, "shaderStorageImageWriteWithoutFormat"},
        {f.features.imageCubeArray, "imageCubeArray"},
    };
    for (size_t i = 0; i < sizeof required / sizeof required[0]; i++)
        if (!required[i].has) {
            snprintf(reason, size, "does not support the feature %s", required[i].name);
            return false;
        }
    if (device_family(physical, NULL) == UINT32_MAX) {
        snprintf(reason, size, "has no compute queue");
        return false;
    }
    const VkFormatFeatureFlags uses = VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                      VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    for (int i = GLINT_FORMAT_R8UI; i <= GLINT_FORMAT_RGBA32F; i++) {
        VkFormatProperties properties;
        vkGetPhysicalDeviceFormatProperties(physical, format_vulkan((enum glint_format)i), &properties);
        if ((properties.optimalTilingFeatures & uses) != uses) {
            snprintf(reason, size, "cannot store and sample images of format %s", format_name((enum glint_format)i));
            return false;
        }
    }
    return true;
}

static const struct {
    VkPhysicalDeviceType type;
    const char *name;
} type_order[] = {
    {VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "discrete"}, {VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, "integrated"},
    {VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU, "virtual"},   {VK_PHYSICAL_DEVICE_TYPE_CPU, "cpu"},
    {VK_PHYSICAL_DEVICE_TYPE_OTHER, "other"},
};
enum { TYPES = sizeof type_order / sizeof type_order[0] };

static size_t type_rank(VkPhysicalDeviceType type) {
    for (size_t i = 0; i < TYPES; i++)
        if (type_order[i].type == type) return i;
    return TYPES - 1;
}

static size_t describe_device(VkPhysicalDevice physical, struct glint_device_info *info) {
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &driver};
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    size_t rank = type_rank(properties.properties.deviceType);
    *info = (struct glint_device_info){.type = type_order[rank].name,
                                       .is_cpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU,
                                       .api_version = properties.properties.apiVersion};
    snprintf(info->name, sizeof info->name, "%s", properties.properties.deviceName);
    snprintf(info->driver, sizeof info->driver, "%s", driver.driverName);
    snprintf(info->driver_version, sizeof info->driver_version, "%s", driver.driverInfo);
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++)
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) &&
            memory.memoryHeaps[i].size > info->memory_bytes)
            info->memory_bytes = memory.memoryHeaps[i].size;
    info->usable = check_usable(physical, info->api_version, info->reason, sizeof info->reason);
    return rank;
}

bool instance_devices(VkInstance instance, VkPhysicalDevice **physical, struct glint_device_info **infos, size_t *count,
                      struct glint_error *err) {
    VkPhysicalDevice found[64];
    struct glint_device_info info[64];
    size_t rank[64];
    uint32_t n = 64;
    VkResult result = vkEnumeratePhysicalDevices(instance, &n, found);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return vk_fail(err, "listing devices", result);
    for (uint32_t i = 0; i < n; i++) rank[i] = describe_device(found[i], &info[i]);
    *physical = calloc(n + 1, sizeof **physical);
    *infos = calloc(n + 1, sizeof **infos);
    if (!*physical || !*infos) {
        free(*physical), free(*infos);
        *physical = NULL, *infos = NULL;
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    }
    *count = 0;
    for (size_t r = 0; r < TYPES; r++) /* stable: the driver's own order within a type */
        for (uint32_t i = 0; i < n; i++)
            if (rank[i] == r) (*physical)[*count] = found[i], (*infos)[(*count)++] = info[i];
    return true;
}
