/* Compute programs: descriptor layout, pipeline layout and pipeline of a pass. The device keeps them for all of its replays,
   while they may be used again. */
#ifndef GLINT_REPLAY_PROGRAM_H
#define GLINT_REPLAY_PROGRAM_H

#include "gpu.h"
#include "graph.h"
#include "shader.h"

/* Invocations of a workgroup. */
struct workgroup {
    uint32_t width, height;
};
struct workgroup pass_workgroup(const struct glint_pass *pass);

enum {
    PUSH_BYTES_MAX = 128,
    CONSTANTS_MAX = 64,
    CONSTANT_PHASE = 4 /* its id and its place */,
    CONSTANT_FILTER = 995,
    CONSTANT_PROBE = 999
};
/* Those of DISPATCH_LIST: ids, and places among the constants. */
enum { CONSTANT_TILES = 997, CONSTANT_WORKS = 998, PLACE_TILES = 6, PLACE_WORKS = 7 };
#define ALL_TILES UINT32_MAX

/* Values of a pass's parameters as the shader takes them. */
struct constants {
    VkSpecializationMapEntry entries[CONSTANTS_MAX];
    uint32_t data[CONSTANTS_MAX];
    uint32_t count;
    uint32_t push[PUSH_BYTES_MAX / 4]; /* the dispatch's level first */
    uint32_t push_count;
    bool probed; /* the shader tells of probed pixels */
};
bool constants_init(struct constants *constants, const struct graph *graph, const struct graph_pass *pass,
                    const struct spirv *spirv, const struct glint_replay_options *options, uint32_t block, bool by_hand,
                    struct glint_error *err);

struct program {
    uint64_t key;
    VkDescriptorSetLayout images;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    struct program *next;
};

VkDescriptorType row_descriptor(const struct glint_row *row);

struct programs {
    struct program *first;
    VkDescriptorSetLayout frame; /* set 1 */
    VkSampler linear, nearest;
};
bool programs_init(struct programs *programs, struct gpu *gpu, struct glint_error *err);
void programs_finish(struct programs *programs, struct gpu *gpu);
/* Finds or makes the program of a pass, or of one phase of it, whose constant is set. */
struct program *programs_get(struct programs *programs, struct gpu *gpu, const struct glint_pass *pass,
                             const struct spirv *spirv, const struct constants *constants, struct glint_error *err);

#endif
