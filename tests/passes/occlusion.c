#include "occlusion.h"

#include <string.h>

void occlusion_arrange(struct gpu *gpu, const char *const *words) {
    static const char *const others[] = {"screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace",
                                         "resolve",      "upscale",        "compose",        NULL};
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_without(gpu, others);
    for (; *words; words++) {
        const char *point = strchr(*words, '.');
        if (point && point < strchr(*words, '=')) gpu_set(gpu, *words);
        else gpu_use(gpu, *words);
    }
}

void occlusion_load(struct gpu *gpu, const struct plain *plain) {
    char path[256];
    plain_capture(gpu_path(gpu, "shapes", path), plain);
    gpu_load(gpu, "shapes");
}

struct plain occlusion_frame(const struct shapes *shapes, double fov_y_degrees) {
    return (struct plain){.width = 160,
                          .height = 120,
                          .roughness = 0.5F,
                          .fov_y_degrees = fov_y_degrees,
                          .spoil = shapes_spoil,
                          .user = shapes};
}
