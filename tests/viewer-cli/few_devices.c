/* Preloaded before libvulkan: simulates a driver with few resources for programs with several devices. $FEW_DEVICES: "open" allows one
   device at a time, "memory" allocates no memory while there are two. Refusals are printed to stderr. */
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

static atomic_int devices;

static bool is_asked_for(const char *what) {
    const char *mode = getenv("FEW_DEVICES");
    return mode && strcmp(mode, what) == 0;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                              const VkAllocationCallbacks *allocator, VkDevice *device) {
    PFN_vkCreateDevice create;
    *(void **)&create = dlsym(RTLD_NEXT, "vkCreateDevice");
    if (atomic_fetch_add(&devices, 1) > 0 && is_asked_for("open")) {
        atomic_fetch_sub(&devices, 1);
        fputs("refused a device\n", stderr);
        return VK_ERROR_TOO_MANY_OBJECTS;
    }
    const VkResult result = create(physical, info, allocator, device);
    if (result != VK_SUCCESS) atomic_fetch_sub(&devices, 1);
    return result;
}

VKAPI_ATTR void VKAPI_CALL vkDestroyDevice(VkDevice device, const VkAllocationCallbacks *allocator) {
    PFN_vkDestroyDevice destroy;
    *(void **)&destroy = dlsym(RTLD_NEXT, "vkDestroyDevice");
    destroy(device, allocator);
    atomic_fetch_sub(&devices, 1);
}

VKAPI_ATTR VkResult VKAPI_CALL vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo *info,
                                                const VkAllocationCallbacks *allocator, VkDeviceMemory *memory) {
    PFN_vkAllocateMemory allocate;
    *(void **)&allocate = dlsym(RTLD_NEXT, "vkAllocateMemory");
    if (atomic_load(&devices) > 1 && is_asked_for("memory")) {
        fputs("refused memory\n", stderr);
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    return allocate(device, info, allocator, memory);
}
