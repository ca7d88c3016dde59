/* A Vulkan layer that lets calls fail, for tests of what glint does then. Environment variables say what fails, in all processes that load it:

   GLINT_FAULT_CALL    the name of a function, such as vkAllocateMemory
   GLINT_FAULT_RESULT  what it returns, such as VK_ERROR_OUT_OF_DEVICE_MEMORY; VK_ERROR_DEVICE_LOST without it
   GLINT_FAULT_FROM    the number of its first call that fails, 1 without it, counted in the process since one of these variables changed
   GLINT_FAULT_TIMES   how many calls fail; all from the first on without it
   GLINT_FAULT_SECONDS instead of failing they take so many seconds longer
   GLINT_FAULT_FILE    while a file of this name exists, devices are lost at the next call that a lost device fails, and none can be created
   GLINT_FAULT_COUNTS  a file to which each process appends how often it called each function, when its last instance is destroyed
   GLINT_FAULT_LIVE    a file that says at each submission how many objects of the device there are, how many bytes of the heap are in use, and how many of
                       them threads of glint hold, if tests/faults/live_heap.c is preloaded

   GLINT_FAULT_STAY    a library that is not unloaded, so that a sanitizer can name what the driver never frees

   What is not destroyed when its device is, is told on stderr. A call that destroys something while the device may still execute ends the process.

   A device of which any call has returned VK_ERROR_DEVICE_LOST is lost: from then on it executes nothing, and returns that from the calls that wait, submit
   and read results. Its other functions go on working, as the specification has it: objects of a lost device are created and destroyed. */
#include <dlfcn.h>
#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

/* clang-format off */
/* DEVICE_CALL(whether a lost device fails it, name, parameters after the handle, their names): called with a device */
#define DEVICE_CALLS \
    DEVICE_CALL(false, AllocateMemory, (VkDevice h, const VkMemoryAllocateInfo *a, const VkAllocationCallbacks *b, VkDeviceMemory *c), (h, a, b, c)) \
    DEVICE_CALL(false, MapMemory, (VkDevice h, VkDeviceMemory a, VkDeviceSize b, VkDeviceSize c, VkMemoryMapFlags d, void **e), (h, a, b, c, d, e)) \
    DEVICE_CALL(false, BindBufferMemory, (VkDevice h, VkBuffer a, VkDeviceMemory b, VkDeviceSize c), (h, a, b, c)) \
    DEVICE_CALL(false, BindImageMemory, (VkDevice h, VkImage a, VkDeviceMemory b, VkDeviceSize c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateBuffer, (VkDevice h, const VkBufferCreateInfo *a, const VkAllocationCallbacks *b, VkBuffer *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateBufferView, (VkDevice h, const VkBufferViewCreateInfo *a, const VkAllocationCallbacks *b, VkBufferView *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateImage, (VkDevice h, const VkImageCreateInfo *a, const VkAllocationCallbacks *b, VkImage *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateImageView, (VkDevice h, const VkImageViewCreateInfo *a, const VkAllocationCallbacks *b, VkImageView *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateSampler, (VkDevice h, const VkSamplerCreateInfo *a, const VkAllocationCallbacks *b, VkSampler *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateShaderModule, (VkDevice h, const VkShaderModuleCreateInfo *a, const VkAllocationCallbacks *b, VkShaderModule *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreatePipelineCache, (VkDevice h, const VkPipelineCacheCreateInfo *a, const VkAllocationCallbacks *b, VkPipelineCache *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreatePipelineLayout, (VkDevice h, const VkPipelineLayoutCreateInfo *a, const VkAllocationCallbacks *b, VkPipelineLayout *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateComputePipelines, (VkDevice h, VkPipelineCache a, uint32_t b, const VkComputePipelineCreateInfo *c, const VkAllocationCallbacks *d, VkPipeline *e), (h, a, b, c, d, e)) \
    DEVICE_CALL(false, CreateDescriptorSetLayout, (VkDevice h, const VkDescriptorSetLayoutCreateInfo *a, const VkAllocationCallbacks *b, VkDescriptorSetLayout *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateDescriptorPool, (VkDevice h, const VkDescriptorPoolCreateInfo *a, const VkAllocationCallbacks *b, VkDescriptorPool *c), (h, a, b, c)) \
    DEVICE_CALL(false, AllocateDescriptorSets, (VkDevice h, const VkDescriptorSetAllocateInfo *a, VkDescriptorSet *b), (h, a, b)) \
    DEVICE_CALL(false, CreateCommandPool, (VkDevice h, const VkCommandPoolCreateInfo *a, const VkAllocationCallbacks *b, VkCommandPool *c), (h, a, b, c)) \
    DEVICE_CALL(false, AllocateCommandBuffers, (VkDevice h, const VkCommandBufferAllocateInfo *a, VkCommandBuffer *b), (h, a, b)) \
    DEVICE_CALL(false, ResetCommandPool, (VkDevice h, VkCommandPool a, VkCommandPoolResetFlags b), (h, a, b)) \
    DEVICE_CALL(false, BeginCommandBuffer, (VkCommandBuffer h, const VkCommandBufferBeginInfo *a), (h, a)) \
    DEVICE_CALL(false, EndCommandBuffer, (VkCommandBuffer h), (h)) \
    DEVICE_CALL(false, CreateQueryPool, (VkDevice h, const VkQueryPoolCreateInfo *a, const VkAllocationCallbacks *b, VkQueryPool *c), (h, a, b, c)) \
    DEVICE_CALL(false, CreateFence, (VkDevice h, const VkFenceCreateInfo *a, const VkAllocationCallbacks *b, VkFence *c), (h, a, b, c)) \
    DEVICE_CALL(false, ResetFences, (VkDevice h, uint32_t a, const VkFence *b), (h, a, b)) \
    DEVICE_CALL(true, GetFenceStatus, (VkDevice h, VkFence a), (h, a)) \
    DEVICE_CALL(true, WaitForFences, (VkDevice h, uint32_t a, const VkFence *b, VkBool32 c, uint64_t d), (h, a, b, c, d)) \
    DEVICE_CALL(true, GetQueryPoolResults, (VkDevice h, VkQueryPool a, uint32_t b, uint32_t c, size_t d, void *e, VkDeviceSize f, VkQueryResultFlags g), (h, a, b, c, d, e, f, g)) \
    DEVICE_CALL(true, QueueSubmit, (VkQueue h, uint32_t a, const VkSubmitInfo *b, VkFence c), (h, a, b, c)) \
    DEVICE_CALL(true, QueueSubmit2, (VkQueue h, uint32_t a, const VkSubmitInfo2 *b, VkFence c), (h, a, b, c)) \
    DEVICE_CALL(true, QueueWaitIdle, (VkQueue h), (h)) \
    DEVICE_CALL(true, DeviceWaitIdle, (VkDevice h), (h))
#define INSTANCE_CALLS \
    INSTANCE_CALL(EnumeratePhysicalDevices, (VkInstance h, uint32_t *a, VkPhysicalDevice *b), (h, a, b)) \
    INSTANCE_CALL(GetPhysicalDeviceImageFormatProperties, (VkPhysicalDevice h, VkFormat a, VkImageType b, VkImageTiling c, VkImageUsageFlags d, VkImageCreateFlags e, VkImageFormatProperties *f), (h, a, b, c, d, e, f))
/* DESTROY(the call that makes it, the one that destroys it, its type): what has to be destroyed before the device is */
#define DESTROYS \
    DESTROY(AllocateMemory, FreeMemory, VkDeviceMemory) \
    DESTROY(CreateBuffer, DestroyBuffer, VkBuffer) \
    DESTROY(CreateBufferView, DestroyBufferView, VkBufferView) \
    DESTROY(CreateImage, DestroyImage, VkImage) \
    DESTROY(CreateImageView, DestroyImageView, VkImageView) \
    DESTROY(CreateSampler, DestroySampler, VkSampler) \
    DESTROY(CreateShaderModule, DestroyShaderModule, VkShaderModule) \
    DESTROY(CreatePipelineCache, DestroyPipelineCache, VkPipelineCache) \
    DESTROY(CreatePipelineLayout, DestroyPipelineLayout, VkPipelineLayout) \
    DESTROY(CreateComputePipelines, DestroyPipeline, VkPipeline) \
    DESTROY(CreateDescriptorSetLayout, DestroyDescriptorSetLayout, VkDescriptorSetLayout) \
    DESTROY(CreateDescriptorPool, DestroyDescriptorPool, VkDescriptorPool) \
    DESTROY(CreateCommandPool, DestroyCommandPool, VkCommandPool) \
    DESTROY(CreateQueryPool, DestroyQueryPool, VkQueryPool) \
    DESTROY(CreateFence, DestroyFence, VkFence)
/* clang-format on */

enum call {
#define DEVICE_CALL(fails, name, parameters, arguments) CALL_##name,
#define INSTANCE_CALL(name, parameters, arguments) CALL_##name,
    DEVICE_CALLS INSTANCE_CALLS
#undef DEVICE_CALL
#undef INSTANCE_CALL
        CALL_CreateInstance,
    CALL_CreateDevice,
    CALLS
};
/* Functions that cannot fail. */
enum {
    CALL_DestroyInstance = CALLS,
    CALL_DestroyDevice,
    CALL_GetInstanceProcAddr,
    CALL_GetDeviceProcAddr,
#define DESTROY(made_by, name, type) CALL_##name,
    DESTROYS
#undef DESTROY
        FUNCTIONS
};

static const char *const call_names[] = {
#define DEVICE_CALL(fails, name, parameters, arguments) "vk" #name,
#define INSTANCE_CALL(name, parameters, arguments) "vk" #name,
    DEVICE_CALLS INSTANCE_CALLS
#undef DEVICE_CALL
#undef INSTANCE_CALL
    "vkCreateInstance",
    "vkCreateDevice",
    "vkDestroyInstance",
    "vkDestroyDevice",
    "vkGetInstanceProcAddr",
    "vkGetDeviceProcAddr",
#define DESTROY(made_by, name, type) "vk" #name,
    DESTROYS
#undef DESTROY
};

/* Instances and devices by the loader's table, to which queues, command buffers and physical devices point, too. */
struct object {
    void *table;
    bool lost, executes; /* executes: something was submitted, and nothing has waited for it */
    VkInstance instance;
    VkDevice device;
    long made[CALLS];                   /* by each call, less those that were destroyed */
    PFN_vkVoidFunction next[FUNCTIONS]; /* of the layer below, which has to be asked while the object is created */
};
static struct object objects[64];
static size_t object_count, instance_count;
static unsigned long counts[CALLS], since; /* since: calls of GLINT_FAULT_CALL since the variables changed */
static char variables[512];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static void *table_of(const void *handle) {
    return *(void *const *)handle;
}

/* Entries are never moved while their object exists. */
static struct object *object_find(const void *handle) {
    void *table = table_of(handle);
    struct object *found = NULL;
    pthread_mutex_lock(&lock);
    for (size_t i = 0; i < object_count; i++)
        if (objects[i].table == table) found = &objects[i];
    pthread_mutex_unlock(&lock);
    return found;
}

static void object_add(const struct object *object) {
    pthread_mutex_lock(&lock);
    size_t i = 0;
    while (i < object_count && objects[i].table) i++;
    if (i == sizeof objects / sizeof *objects) abort();
    objects[i] = *object;
    if (i == object_count) object_count++;
    instance_count += object->instance != NULL;
    pthread_mutex_unlock(&lock);
}

/* ---- What fails ---- */

static VkResult result_of_name(const char *name) {
    static const struct {
        const char *name;
        VkResult result;
    } results[] = {{"VK_ERROR_DEVICE_LOST", VK_ERROR_DEVICE_LOST},
                   {"VK_ERROR_OUT_OF_HOST_MEMORY", VK_ERROR_OUT_OF_HOST_MEMORY},
                   {"VK_ERROR_OUT_OF_DEVICE_MEMORY", VK_ERROR_OUT_OF_DEVICE_MEMORY},
                   {"VK_ERROR_INITIALIZATION_FAILED", VK_ERROR_INITIALIZATION_FAILED},
                   {"VK_ERROR_UNKNOWN", VK_ERROR_UNKNOWN},
                   {"VK_TIMEOUT", VK_TIMEOUT},
                   {"VK_NOT_READY", VK_NOT_READY}};
    for (size_t i = 0; name && i < sizeof results / sizeof *results; i++)
        if (!strcmp(results[i].name, name)) return results[i].result;
    return VK_ERROR_DEVICE_LOST;
}

static unsigned long number_of(const char *variable, unsigned long otherwise) {
    const char *text = getenv(variable);
    return text && *text ? strtoul(text, NULL, 10) : otherwise;
}

static bool file_is_there(void) {
    const char *file = getenv("GLINT_FAULT_FILE");
    return file && access(file, F_OK) == 0;
}

/* Counts the call. VK_SUCCESS: it is passed on. */
static VkResult fault_of(enum call call) {
    const char *name = getenv("GLINT_FAULT_CALL");
    const unsigned long from = number_of("GLINT_FAULT_FROM", 1), times = number_of("GLINT_FAULT_TIMES", 0);
    const bool named = name && strcmp(name, call_names[call]) == 0;
    char now[sizeof variables];
    snprintf(now, sizeof now, "%s %lu %lu", name ? name : "", from, times);
    pthread_mutex_lock(&lock);
    counts[call]++;
    if (strcmp(now, variables) != 0) since = 0;
    memcpy(variables, now, sizeof now);
    const unsigned long number = since += named;
    pthread_mutex_unlock(&lock);
    if (!named || number < from || (times && number >= from + times)) return VK_SUCCESS;
    const unsigned long seconds = number_of("GLINT_FAULT_SECONDS", 0);
    if (seconds) return sleep((unsigned)seconds), VK_SUCCESS;
    return result_of_name(getenv("GLINT_FAULT_RESULT"));
}

/* ---- Devices ---- */

/* What the driver still executes ends first: a lost device executes nothing. */
static void lose(struct object *object) {
    PFN_vkDeviceWaitIdle wait = (PFN_vkDeviceWaitIdle)object->next[CALL_DeviceWaitIdle];
    object->lost = true;
    wait(object->device);
    object->executes = false;
}

static VkResult fault_of_device(struct object *object, enum call call, bool fails_when_lost) {
    VkResult result = fault_of(call);
    if (fails_when_lost && (object->lost || file_is_there())) result = VK_ERROR_DEVICE_LOST;
    if (result == VK_ERROR_DEVICE_LOST) lose(object);
    return result;
}

static void count_made(struct object *object, enum call call, long more) {
    pthread_mutex_lock(&lock);
    object->made[call] += more;
    pthread_mutex_unlock(&lock);
}

/* Overwrites the line of the submission before, which has the same length. */
static void tell_live(const struct object *object) {
    const char *path = getenv("GLINT_FAULT_LIVE");
    const int file = path ? open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0600) : -1;
    if (file < 0) return;
    long count = 0;
#define DESTROY(made_by, name, type) count += object->made[CALL_##made_by];
    DESTROYS
#undef DESTROY
    const struct mallinfo2 heap = mallinfo2();
    size_t (*held)(void) = NULL;
    *(void **)&held = dlsym(RTLD_DEFAULT, "live_heap_bytes");
    if (dprintf(file, "%20ld %20zu %20zu\n", count, heap.uordblks + heap.hblkhd, held ? held() : 0) < 0) abort();
    close(file);
}

static void note_success(struct object *object, enum call call) {
    count_made(object, call, 1);
    if (call == CALL_QueueSubmit || call == CALL_QueueSubmit2) {
        object->executes = true;
        tell_live(object);
    }
    if (call == CALL_WaitForFences || call == CALL_QueueWaitIdle || call == CALL_DeviceWaitIdle)
        object->executes = false;
}

static void note_destroyed(struct object *object, enum call made_by, const char *name) {
    count_made(object, made_by, -1);
    if (!object->executes) return;
    fprintf(stderr, "fault layer: vk%s while the device may execute\n", name);
    abort();
}

#define DESTROY(made_by, name, type)                                                                                   \
    static VKAPI_ATTR void VKAPI_CALL fault_##name(VkDevice h, type one, const VkAllocationCallbacks *allocator) {     \
        struct object *object = object_find(h);                                                                        \
        if (one) note_destroyed(object, CALL_##made_by, #name);                                                        \
        ((PFN_vk##name)object->next[CALL_##name])(h, one, allocator);                                                  \
    }
DESTROYS
#undef DESTROY

static void tell_left(const struct object *object) {
#define DESTROY(made_by, name, type)                                                                                   \
    if (object->made[CALL_##made_by])                                                                                  \
        fprintf(stderr, "fault layer: %ld of vk%s are not destroyed\n", object->made[CALL_##made_by], #made_by);
    DESTROYS
#undef DESTROY
}

#define DEVICE_CALL(fails, name, parameters, arguments)                                                                \
    static VKAPI_ATTR VkResult VKAPI_CALL fault_##name parameters {                                                    \
        struct object *object = object_find(h);                                                                        \
        VkResult result = fault_of_device(object, CALL_##name, fails);                                                 \
        if (!result) result = ((PFN_vk##name)object->next[CALL_##name])arguments;                                      \
        if (!result) note_success(object, CALL_##name);                                                                \
        return result;                                                                                                 \
    }
DEVICE_CALLS
#undef DEVICE_CALL

#define INSTANCE_CALL(name, parameters, arguments)                                                                     \
    static VKAPI_ATTR VkResult VKAPI_CALL fault_##name parameters {                                                    \
        struct object *object = object_find(h);                                                                        \
        const VkResult result = fault_of(CALL_##name);                                                                 \
        return result ? result : ((PFN_vk##name)object->next[CALL_##name])arguments;                                   \
    }
INSTANCE_CALLS
#undef INSTANCE_CALL

static VKAPI_ATTR void VKAPI_CALL fault_DestroyDevice(VkDevice device, const VkAllocationCallbacks *allocator) {
    if (!device) return;
    struct object *object = object_find(device);
    PFN_vkDestroyDevice next = (PFN_vkDestroyDevice)object->next[CALL_DestroyDevice];
    tell_left(object);
    object->table = NULL;
    next(device, allocator);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_CreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                                         const VkAllocationCallbacks *allocator, VkDevice *device) {
    const struct object *instance = object_find(physical);
    VkLayerDeviceCreateInfo *link = (VkLayerDeviceCreateInfo *)info->pNext;
    while (link &&
           !(link->sType == VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO && link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerDeviceCreateInfo *)link->pNext;
    VkResult result = fault_of(CALL_CreateDevice);
    if (!result && file_is_there()) result = VK_ERROR_DEVICE_LOST;
    if (result || !link) return result ? result : VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr instance_next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr device_next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    PFN_vkCreateDevice next = (PFN_vkCreateDevice)instance_next(instance->instance, "vkCreateDevice");
    result = next(physical, info, allocator, device);
    if (result) return result;
    struct object made = {.table = table_of(*device), .device = *device};
    for (size_t i = 0; i < FUNCTIONS; i++) made.next[i] = device_next(*device, call_names[i]);
    object_add(&made);
    return VK_SUCCESS;
}

/* ---- Instances ---- */

static void write_counts(void) {
    const char *path = getenv("GLINT_FAULT_COUNTS");
    FILE *file = path ? fopen(path, "a") : NULL;
    for (size_t i = 0; file && i < CALLS; i++)
        if (counts[i]) fprintf(file, "%s %lu\n", call_names[i], counts[i]);
    if (file) fclose(file);
    memset(counts, 0, sizeof counts);
}

static VKAPI_ATTR void VKAPI_CALL fault_DestroyInstance(VkInstance instance, const VkAllocationCallbacks *allocator) {
    if (!instance) return;
    struct object *object = object_find(instance);
    PFN_vkDestroyInstance next = (PFN_vkDestroyInstance)object->next[CALL_DestroyInstance];
    object->table = NULL;
    if (--instance_count == 0) write_counts();
    next(instance, allocator);
}

static VKAPI_ATTR VkResult VKAPI_CALL fault_CreateInstance(const VkInstanceCreateInfo *info,
                                                           const VkAllocationCallbacks *allocator,
                                                           VkInstance *instance) {
    VkLayerInstanceCreateInfo *link = (VkLayerInstanceCreateInfo *)info->pNext;
    while (link &&
           !(link->sType == VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO && link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerInstanceCreateInfo *)link->pNext;
    VkResult result = fault_of(CALL_CreateInstance);
    if (result || !link) return result ? result : VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    result = ((PFN_vkCreateInstance)next(NULL, "vkCreateInstance"))(info, allocator, instance);
    if (result) return result;
    struct object made = {.table = table_of(*instance), .instance = *instance};
    for (size_t i = 0; i < FUNCTIONS; i++) made.next[i] = next(*instance, call_names[i]);
    object_add(&made);
    return VK_SUCCESS;
}

/* ---- The loader's side ---- */

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetDeviceProcAddr(VkDevice device, const char *name);
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetInstanceProcAddr(VkInstance instance, const char *name);

static PFN_vkVoidFunction own_function(const char *name, bool of_device) {
    static const struct {
        const char *name;
        bool of_device;
        PFN_vkVoidFunction function;
    } own[] = {
#define DEVICE_CALL(fails, name, parameters, arguments) {"vk" #name, true, (PFN_vkVoidFunction)fault_##name},
#define INSTANCE_CALL(name, parameters, arguments) {"vk" #name, false, (PFN_vkVoidFunction)fault_##name},
        DEVICE_CALLS INSTANCE_CALLS
#undef DEVICE_CALL
#undef INSTANCE_CALL
        {"vkCreateInstance", false, (PFN_vkVoidFunction)fault_CreateInstance},
        {"vkDestroyInstance", false, (PFN_vkVoidFunction)fault_DestroyInstance},
        {"vkCreateDevice", false, (PFN_vkVoidFunction)fault_CreateDevice},
        {"vkDestroyDevice", true, (PFN_vkVoidFunction)fault_DestroyDevice},
#define DESTROY(made_by, name, type) {"vk" #name, true, (PFN_vkVoidFunction)fault_##name},
        DESTROYS
#undef DESTROY
        {"vkGetInstanceProcAddr", false, (PFN_vkVoidFunction)fault_GetInstanceProcAddr},
        {"vkGetDeviceProcAddr", true, (PFN_vkVoidFunction)fault_GetDeviceProcAddr},
    };
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (!strcmp(own[i].name, name) && (own[i].of_device || !of_device)) return own[i].function;
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetDeviceProcAddr(VkDevice device, const char *name) {
    const PFN_vkVoidFunction own = own_function(name, true);
    return own ? own : ((PFN_vkGetDeviceProcAddr)object_find(device)->next[CALL_GetDeviceProcAddr])(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fault_GetInstanceProcAddr(VkInstance instance, const char *name) {
    const PFN_vkVoidFunction own = own_function(name, false);
    const struct object *object = own || !instance ? NULL : object_find(instance);
    return object ? ((PFN_vkGetInstanceProcAddr)object->next[CALL_GetInstanceProcAddr])(instance, name) : own;
}

VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *interface);

VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *interface) {
    const char *stay = getenv("GLINT_FAULT_STAY");
    if (stay) dlopen(stay, RTLD_LAZY | RTLD_NODELETE);
    if (interface->loaderLayerInterfaceVersion > 2) interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = fault_GetInstanceProcAddr;
    interface->pfnGetDeviceProcAddr = fault_GetDeviceProcAddr;
    interface->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
