/* Lets the driver compile a user's shader for as long as a pass may take. A driver takes hours for some shaders, cannot be asked to stop, and cannot run in a process
   of its own: so a thread waits for it, and is left where it is. */
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

#include "program.h"

struct compilation {
    pthread_mutex_t lock;
    pthread_cond_t ended;
    VkDevice device;
    VkPipelineCache cache;
    VkComputePipelineCreateInfo info;
    VkSpecializationInfo values;
    struct constants constants;
    VkPipeline pipeline;
    VkResult result;
    bool done, left; /* left: nobody waits any more */
};

static void compilation_free(struct compilation *c) {
    pthread_mutex_destroy(&c->lock);
    pthread_cond_destroy(&c->ended);
    free(c);
}

static void *compile(void *user) {
    struct compilation *c = user;
    const VkResult result = vkCreateComputePipelines(c->device, c->cache, 1, &c->info, NULL, &c->pipeline);
    pthread_mutex_lock(&c->lock);
    c->result = result;
    c->done = true;
    const bool left = c->left;
    pthread_cond_signal(&c->ended);
    pthread_mutex_unlock(&c->lock);
    if (left) compilation_free(c);
    return NULL;
}

static struct compilation *compilation_create(const struct gpu *gpu, const VkComputePipelineCreateInfo *info,
                                              const struct constants *constants) {
    struct compilation *c = calloc(1, sizeof *c);
    pthread_condattr_t monotonic;
    if (!c) return NULL;
    c->device = gpu->device;
    c->cache = gpu->cache;
    c->info = *info;
    c->constants = *constants;
    c->values = *info->stage.pSpecializationInfo;
    c->values.pMapEntries = c->constants.entries;
    c->values.pData = c->constants.data;
    c->info.stage.pSpecializationInfo = &c->values;
    c->info.stage.pName = "main";
    pthread_mutex_init(&c->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&c->ended, &monotonic);
    pthread_condattr_destroy(&monotonic);
    return c;
}

/* As in gpu.c, a second at a time. */
static bool wait_for(struct compilation *c, double limit_s) {
    struct timespec until;
    pthread_mutex_lock(&c->lock);
    for (double waited_s = 0; !c->done && waited_s < limit_s; waited_s++) {
        clock_gettime(CLOCK_MONOTONIC, &until);
        until.tv_sec++;
        pthread_cond_timedwait(&c->ended, &c->lock, &until);
    }
    const bool done = c->done;
    c->left = !done;
    pthread_mutex_unlock(&c->lock);
    return done;
}

bool pipeline_create_patiently(struct gpu *gpu, const VkComputePipelineCreateInfo *info,
                               const struct constants *constants, const char *name, VkPipeline *pipeline,
                               struct glint_error *err) {
    struct compilation *c = compilation_create(gpu, info, constants);
    pthread_t thread;
    if (!c || pthread_create(&thread, NULL, compile, c) != 0) {
        if (c) compilation_free(c);
        return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory, or of threads", name);
    }
    if (!wait_for(c, gpu->pass_limit_s)) {
        pthread_detach(thread);
        gpu_give_up(gpu);
        return glint_fail(err, GLINT_ERROR_DEVICE,
                          "Vulkan: %s: not compiled by the driver within %.0f s, so the device was given up; "
                          "--dispatch-limit or $GLINT_DISPATCH_LIMIT allows more",
                          name, gpu->pass_limit_s);
    }
    pthread_join(thread, NULL);
    const bool ok = gpu_ok(gpu, c->result, name, err);
    *pipeline = ok ? c->pipeline : VK_NULL_HANDLE;
    compilation_free(c);
    return ok;
}
