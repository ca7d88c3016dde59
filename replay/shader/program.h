/* Compute programs: descriptor set layout, pipeline layout and Vulkan pipeline of a pass. The device caches them for all of its replays. */
#ifndef GLINT_REPLAY_PROGRAM_H
#define GLINT_REPLAY_PROGRAM_H

#include "gpu.h"
#include "graph.h"
#include "shader.h"

/* Size of a workgroup in invocations. */
struct workgroup {
    uint32_t width, height;
};
struct workgroup pass_workgroup(const struct glint_pass *pass, bool is_cpu);

enum {
    PUSH_BYTES_MAX = 128,
    CONSTANTS_MAX = SPIRV_PLACES,
    CONSTANT_PHASE = 4 /* both the id and the index among the constants */,
    CONSTANT_FILTER = 995,
    CONSTANT_PROBE = 999
};
/* Constants for DISPATCH_LIST: their ids, and their indices among the constants. */
enum { CONSTANT_TILES = 997, CONSTANT_WORKS = 998, PLACE_TILES = 6, PLACE_WORKS = 7 };
#define ALL_TILES UINT32_MAX
/* Bytes of the constants' data in memory. No device asks for a larger alignment of uniform buffers. */
enum { VALUES_BYTES = CONSTANTS_MAX * sizeof(uint32_t) };

/* A pass's parameters as specialization constants and push constants. */
struct constants {
    VkSpecializationMapEntry entries[CONSTANTS_MAX];
    uint32_t data[CONSTANTS_MAX];
    uint32_t count;
    uint64_t parameters;               /* bits of the indices of those that are values of parameters */
    uint32_t push[PUSH_BYTES_MAX / 4]; /* the first one is the MIP level of the dispatch */
    uint32_t push_count;
    bool probed; /* the shader records probed pixels */
};
bool constants_init(struct constants *constants, const struct graph *graph, const struct graph_pass *pass,
                    const struct spirv *spirv, const struct glint_replay_options *options, bool is_cpu, bool by_hand,
                    struct glint_error *err);

struct program {
    uint64_t key;
    VkDescriptorSetLayout images;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    bool generic; /* reads parameters from memory: set 2 */
    struct program *next;
};

VkDescriptorType row_descriptor(const struct glint_row *row);

struct programs {
    struct program *first;
    struct generic *generic;     /* modules that read parameters from memory */
    VkDescriptorSetLayout frame; /* set 1 */
    VkDescriptorSetLayout
        values; /* set 2 of generic programs: a uniform buffer with a dynamic offset, VALUES_BYTES for each pass */
    uint64_t compiled; /* pipelines created so far */
    VkSampler linear, nearest;
};
bool programs_init(struct programs *programs, struct gpu *gpu, struct glint_error *err);
void programs_finish(struct programs *programs, struct gpu *gpu);
/* patience.c: creates a pipeline from a user's shader, which the driver may compile for as long as a pass may take. */
bool pipeline_create_patiently(struct gpu *gpu, const VkComputePipelineCreateInfo *info,
                               const struct constants *constants, const char *name, VkPipeline *pipeline,
                               struct glint_error *err);
/* Finds or creates the program of a pass with these constants, which differ between its phases. With `quick` it is a generic one unless there
   is one for the values of the parameters already. */
struct program *programs_get(struct programs *programs, struct gpu *gpu, const struct glint_pass *pass,
                             const struct spirv *spirv, const struct constants *constants, bool quick,
                             struct glint_error *err);

#endif
