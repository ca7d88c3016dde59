/* Devices with their shaders and programs. */
#include "device.h"

#include <ctype.h>
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

/* The limit of a pass in seconds; 0: the usual one. */
static bool find_limit(const struct glint_device_options *options, uint32_t *limit_s, struct glint_error *err) {
    const char *text = getenv("GLINT_DISPATCH_LIMIT");
    char *end;
    *limit_s = options ? options->dispatch_limit_s : 0;
    if (*limit_s || !text || !text[0]) return true;
    const unsigned long value = strtoul(text, &end, 10);
    *limit_s = (uint32_t)value;
    return (isdigit((unsigned char)text[0]) && !*end && value >= 1 && value <= UINT32_MAX) ||
           glint_fail(err, GLINT_ERROR_USAGE, "GLINT_DISPATCH_LIMIT=%s: expected whole seconds from 1 on", text);
}

static bool open_gpu(struct glint_device *device, struct glint_error *err) {
    if (!gpu_init(&device->gpu, device->select, device->validate, device->limit_s, err)) return false;
    describe_for_passes(&device->gpu.info);
    device->shaders.clamp = device->gpu.info.is_cpu;
    return programs_init(&device->programs, &device->gpu, err);
}

static void close_gpu(struct glint_device *device) {
    gpu_wait(&device->gpu);
    programs_finish(&device->programs, &device->gpu);
    gpu_finish(&device->gpu);
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
    device->validate = (options && options->validation) || (validation && strcmp(validation, "1") == 0);
    if (select && select[0] && !(device->select = strdup(select))) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        glint_device_destroy(&device);
    } else if (!find_limit(options, &device->limit_s, err) || !shaders_init(&device->shaders, passes, err) ||
               !open_gpu(device, err))
        glint_device_destroy(&device);
    return device;
}

bool glint_device_reopen(struct glint_device *device, struct glint_error *err) {
    struct glint_device_info before = device->gpu.info;
    close_gpu(device);
    struct glint_error own = {0};
    if (!open_gpu(device, &own)) {
        close_gpu(device);
        device->gpu.info = before;
        device->gpu.lost = true;
        return glint_fail(err, own.code, "%s was lost, and cannot be opened again: %s", before.name, own.message);
    }
    const struct glint_device_info *now = &device->gpu.info;
    return (!strcmp(now->name, before.name) && !strcmp(now->driver_version, before.driver_version)) ||
           glint_fail(err, GLINT_ERROR_DEVICE, "%s was lost, and in its place there is %s, whose results may differ",
                      before.name, now->name);
}

void glint_device_destroy(struct glint_device **pointer) {
    struct glint_device *device = *pointer;
    *pointer = NULL;
    if (!device) return;
    close_gpu(device);
    shaders_finish(&device->shaders);
    free(device->select);
    free(device);
}

const struct glint_device_info *glint_device_get_info(const struct glint_device *device) {
    return &device->gpu.info;
}

bool glint_device_lost(const struct glint_device *device) {
    return device->gpu.lost;
}

bool glint_device_given_up(const struct glint_device *device) {
    return device ? device->gpu.given_up : gpu_gave_up();
}

uint32_t glint_device_messages(const struct glint_device *device, const char **last) {
    if (last) *last = device->gpu.messages.last;
    return device->gpu.messages.count;
}
