/* Devices with their shaders and programs. */
#include "device.h"

#include <stdlib.h>
#include <string.h>

/* Properties of the device that passes depend on. */
static void describe_for_passes(struct glint_device_info *info) {
    info->filters_together = info->is_cpu;
}

size_t glint_devices(struct glint_device_info *devices, size_t capacity, struct glint_error *err) {
    struct instance instance = {0};
    VkPhysicalDevice *physical = NULL;
    struct glint_device_info *infos = NULL;
    size_t count = 0;
    if (instance_init(&instance, NULL, err) && instance_devices(instance.instance, &physical, &infos, &count, err)) {
        for (size_t i = 0; i < count && i < capacity; i++) describe_for_passes(&infos[i]), devices[i] = infos[i];
        free(physical), free(infos);
    }
    instance_finish(&instance);
    return count;
}

struct glint_device *glint_device_create(const struct glint_device_options *options, struct glint_error *err) {
    struct glint_device *device = calloc(1, sizeof *device);
    if (!device) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    const char *select = options && options->select ? options->select : getenv("GLINT_DEVICE");
    const char *passes = options && options->passes ? options->passes : getenv("GLINT_PASSES");
    const char *validation = getenv("GLINT_VALIDATION");
    const bool validate = (options && options->validation) || (validation && strcmp(validation, "1") == 0);
    if (!shaders_init(&device->shaders, passes, err) ||
        !gpu_init(&device->gpu, select && select[0] ? select : NULL, validate, err)) {
        shaders_finish(&device->shaders);
        free(device);
        return NULL;
    }
    describe_for_passes(&device->gpu.info);
    if (!programs_init(&device->programs, &device->gpu, err)) glint_device_destroy(&device);
    return device;
}

void glint_device_destroy(struct glint_device **pointer) {
    struct glint_device *device = *pointer;
    *pointer = NULL;
    if (!device) return;
    gpu_wait(&device->gpu);
    programs_finish(&device->programs, &device->gpu);
    gpu_finish(&device->gpu);
    shaders_finish(&device->shaders);
    free(device);
}

const struct glint_device_info *glint_device_get_info(const struct glint_device *device) {
    return &device->gpu.info;
}

bool glint_device_lost(const struct glint_device *device) {
    return device->gpu.lost;
}

uint32_t glint_device_messages(const struct glint_device *device, const char **last) {
    if (last) *last = device->gpu.messages.last;
    return device->gpu.messages.count;
}
