/* A device as callers see it: the Vulkan device, compiled shaders and the programs that all of its replays share. */
#ifndef GLINT_REPLAY_DEVICE_H
#define GLINT_REPLAY_DEVICE_H

#include "gpu.h"
#include "program.h"
#include "shader.h"

struct glint_device {
    struct gpu gpu;
    struct shaders shaders;
    struct programs programs;
    char *select; /* which device; NULL: the best one */
    uint32_t limit_s;
    bool validate;
};

#endif
