/* Compute programs, created from a pass's rows. The line number of a row is its binding or specialization constant id. */
#include "program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

static uint32_t value_bits(const struct glint_row *row, double value) {
    uint32_t bits;
    if (row->type == GLINT_VALUE_FLOAT) {
        float f = (float)value;
        memcpy(&bits, &f, sizeof bits);
    } else if (row->type == GLINT_VALUE_UINT) bits = (uint32_t)value;
    else bits = (uint32_t)(int32_t)value;
    return bits;
}

static bool add_constant(struct constants *constants, uint32_t id, uint32_t bits) {
    uint32_t i = constants->count;
    if (i == CONSTANTS_MAX) return false;
    constants->entries[i] = (VkSpecializationMapEntry){id, i * (uint32_t)sizeof bits, sizeof bits};
    constants->data[i] = bits;
    constants->count++;
    return true;
}

struct workgroup pass_workgroup(const struct glint_pass *pass, bool is_cpu) {
    const struct glint_row *group = glint_pass_row(pass, GLINT_ROW_WORKGROUP, NULL);
    bool alone = false; /* each invocation works for itself */
    for (size_t r = 0; r < pass->row_count; r++) alone |= pass->rows[r].chain && is_cpu;
    if (!group || alone) return (struct workgroup){8, 8};
    return (struct workgroup){(uint32_t)group->first, (uint32_t)group->last};
}

bool constants_init(struct constants *constants, const struct graph *graph, const struct graph_pass *graph_pass,
                    const struct spirv *spirv, const struct glint_replay_options *options, bool is_cpu, bool by_hand,
                    struct glint_error *err) {
    *constants = (struct constants){.push_count = 1, .probed = spirv->probes && options->probe_count > 0};
    const struct glint_pass *pass = graph_pass->pass;
    const double *values = graph_pass->entry->values;
    uint32_t facts = 0;
    const struct workgroup group = pass_workgroup(pass, is_cpu);
    const uint32_t place = (uint32_t)(graph_pass - graph->passes) + 1;
    bool fits = add_constant(constants, 0, options->diagnostics) &&
                add_constant(constants, CONSTANT_PROBE, constants->probed ? place : 0) &&
                add_constant(constants, 1, group.width) && add_constant(constants, 2, group.height) &&
                add_constant(constants, CONSTANT_PHASE, 0) && add_constant(constants, 3, !options->float_precision) &&
                add_constant(constants, CONSTANT_TILES, ALL_TILES) && add_constant(constants, CONSTANT_WORKS, true) &&
                add_constant(constants, CONSTANT_FILTER, by_hand);
    for (size_t i = 0; i < pass->row_count && fits; i++) {
        uint32_t bits = glint_row_is_parameter(&pass->rows[i]) ? value_bits(&pass->rows[i], values[i]) : 0;
        if (pass->rows[i].kind == GLINT_ROW_SPEC || pass->rows[i].kind == GLINT_ROW_CHOICE) {
            fits = add_constant(constants, pass->rows[i].id, bits);
            if (fits) constants->parameters |= UINT64_C(1) << (constants->count - 1);
        } else if (pass->rows[i].kind == GLINT_ROW_FACT)
            fits = add_constant(constants, pass->rows[i].id, !(graph_pass->false_facts >> facts++ & 1));
        else if (pass->rows[i].kind == GLINT_ROW_BLOCKS)
            fits = add_constant(constants, pass->rows[i].id, pass_block(pass, is_cpu));
        else if (pass->rows[i].kind == GLINT_ROW_DISPATCH_LEVELS && pass->rows[i].chain)
            fits = add_constant(constants, pass->rows[i].id, row_levels(&pass->rows[i], is_cpu));
        else if (pass->rows[i].optional) /* has_NAME, of OPTIONAL_READ and DISPATCH_LIST */
            fits = add_constant(constants, 1000 + pass->rows[i].id,
                                graph_bound(graph, &pass->rows[i])->source != SOURCE_FALLBACK);
        else if (pass->rows[i].kind == GLINT_ROW_PUSH && (fits = constants->push_count < PUSH_BYTES_MAX / 4))
            constants->push[constants->push_count++] = bits;
    }
    return fits || glint_fail(err, GLINT_ERROR_LIMIT, "%s/%s: more than %d constants or %d bytes of push constants",
                              pass->slot, pass->variant, CONSTANTS_MAX - 9, PUSH_BYTES_MAX);
}

static bool create_sampler(struct gpu *gpu, VkFilter filter, const char *name, VkSampler *sampler,
                           struct glint_error *err) {
    const VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                      .magFilter = filter,
                                      .minFilter = filter,
                                      .mipmapMode = filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                                               : VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                      .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .maxLod = VK_LOD_CLAMP_NONE};
    if (!gpu_ok(gpu, vkCreateSampler(gpu->device, &info, NULL, sampler), "creating a sampler", err)) return false;
    device_set_name(gpu, VK_OBJECT_TYPE_SAMPLER, (uint64_t)(uintptr_t)*sampler, name);
    return true;
}

static void program_destroy(struct program *program, struct gpu *gpu) {
    GPU_DESTROY(gpu, vkDestroyPipeline, program->pipeline);
    GPU_DESTROY(gpu, vkDestroyPipelineLayout, program->layout);
    GPU_DESTROY(gpu, vkDestroyDescriptorSetLayout, program->images);
    free(program);
}

/* A module that reads parameters from memory. */
struct generic {
    const struct glint_pass *pass;
    const uint32_t *from;
    uint32_t *words;
    size_t bytes;
    uint64_t turned; /* bits of the indices of the constants that it reads */
    struct generic *next;
};

void programs_finish(struct programs *programs, struct gpu *gpu) {
    for (struct program *program = programs->first, *next; program; program = next) {
        next = program->next;
        program_destroy(program, gpu);
    }
    for (struct generic *next, *one = programs->generic; one; one = next) {
        next = one->next;
        free(one->words);
        free(one);
    }
    if (gpu->device) {
        GPU_DESTROY(gpu, vkDestroyDescriptorSetLayout, programs->frame);
        GPU_DESTROY(gpu, vkDestroyDescriptorSetLayout, programs->values);
        GPU_DESTROY(gpu, vkDestroySampler, programs->linear);
        GPU_DESTROY(gpu, vkDestroySampler, programs->nearest);
    }
    *programs = (struct programs){0};
}

static bool create_set_layout(struct gpu *gpu, const VkDescriptorSetLayoutBinding *bindings, uint32_t count,
                              const char *name, VkDescriptorSetLayout *layout, struct glint_error *err) {
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = count, .pBindings = bindings};
    if (!gpu_ok(gpu, vkCreateDescriptorSetLayout(gpu->device, &info, NULL, layout), name, err)) return false;
    device_set_name(gpu, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, (uint64_t)(uintptr_t)*layout, name);
    return true;
}

bool programs_init(struct programs *programs, struct gpu *gpu, struct glint_error *err) {
    if (!create_sampler(gpu, VK_FILTER_LINEAR, "linear_clamp", &programs->linear, err) ||
        !create_sampler(gpu, VK_FILTER_NEAREST, "nearest_clamp", &programs->nearest, err))
        return false;
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_SAMPLER, 1, VK_SHADER_STAGE_COMPUTE_BIT, &programs->linear},
        {2, VK_DESCRIPTOR_TYPE_SAMPLER, 1, VK_SHADER_STAGE_COMPUTE_BIT, &programs->nearest},
        {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
    };
    const VkDescriptorSetLayoutBinding values = {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1,
                                                 VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    return create_set_layout(gpu, bindings, 4, "frame", &programs->frame, err) &&
           create_set_layout(gpu, &values, 1, "values", &programs->values, err);
}

VkDescriptorType row_descriptor(const struct glint_row *row) {
    if (strstr(row->glsl, "Buffer"))
        return row_is_sampled(row) ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    return row_is_sampled(row) ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

/* Each device has these limits, and few of them come near what passes need. */
static bool check_limits(const struct gpu *gpu, const struct glint_pass *pass,
                         const VkDescriptorSetLayoutBinding *bindings, uint32_t count, const char *name,
                         struct glint_error *err) {
    const struct workgroup group = pass_workgroup(pass, gpu->info.is_cpu);
    uint32_t sampled = 0, stored = 0;
    for (uint32_t i = 0; i < count; i++) {
        const bool read = bindings[i].descriptorType == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE ||
                          bindings[i].descriptorType == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        *(read ? &sampled : &stored) += bindings[i].descriptorCount;
    }
    const struct {
        uint32_t needed, has;
        const char *limit;
    } needs[] = {
        {sampled, gpu->limits.maxPerStageDescriptorSampledImages, "maxPerStageDescriptorSampledImages"},
        {stored, gpu->limits.maxPerStageDescriptorStorageImages, "maxPerStageDescriptorStorageImages"},
        {group.width * group.height, gpu->limits.maxComputeWorkGroupInvocations, "maxComputeWorkGroupInvocations"},
    };
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++)
        if (needs[i].needed > needs[i].has)
            return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "%s: the device's limit %s is %u, and the pass needs %u",
                              name, needs[i].limit, needs[i].has, needs[i].needed);
    return true;
}

static bool create_layouts(struct program *program, struct gpu *gpu, const struct programs *programs,
                           const struct glint_pass *pass, const struct constants *constants, const char *name,
                           struct glint_error *err) {
    VkDescriptorSetLayoutBinding bindings[PASS_IMAGES_MAX];
    uint32_t count = 0;
    for (size_t i = 0; i < pass->row_count && count < PASS_IMAGES_MAX; i++) {
        const struct glint_row *row = &pass->rows[i];
        if (!row_is_image(row)) continue;
        bindings[count++] = (VkDescriptorSetLayoutBinding){row->id, row_descriptor(row), row_bindings(row),
                                                           VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    }
    if (!check_limits(gpu, pass, bindings, count, name, err) ||
        !create_set_layout(gpu, bindings, count, name, &program->images, err))
        return false;
    const VkDescriptorSetLayout sets[] = {program->images, programs->frame, programs->values};
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, constants->push_count * 4};
    const VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = program->generic ? 3 : 2,
                                               .pSetLayouts = sets,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &push};
    if (!gpu_ok(gpu, vkCreatePipelineLayout(gpu->device, &layout, NULL, &program->layout), name, err)) return false;
    device_set_name(gpu, VK_OBJECT_TYPE_PIPELINE_LAYOUT, (uint64_t)(uintptr_t)program->layout, name);
    return true;
}

struct module {
    const uint32_t *words;
    size_t bytes;
    bool foreign; /* a user's */
};

/* A CPU device compiles the shader without the code of probes in a third of the time; a GPU runs some passes up to a tenth slower from it. */
static struct module module_of(const struct gpu *gpu, const struct spirv *spirv, const struct constants *constants) {
    const bool whole = constants->probed || !gpu->info.is_cpu;
    return whole ? (struct module){spirv->words, spirv->bytes, spirv->from != NULL}
                 : (struct module){spirv->unprobed, spirv->unprobed_bytes, spirv->from != NULL};
}

/* What the driver gets. The caller frees it; NULL: out of memory. */
static uint32_t *words_of(const struct gpu *gpu, struct module from, size_t *bytes) {
    uint32_t *opaque = NULL;
    if (gpu->info.is_cpu && !(opaque = spirv_opaque(from.words, from.bytes, &from.bytes))) return NULL;
    uint32_t *words = spirv_exact(opaque ? opaque : from.words, from.bytes, bytes);
    free(opaque);
    return words;
}

static bool create_pipeline(struct program *program, struct gpu *gpu, struct module from,
                            const struct constants *constants, bool some_layers, const char *name,
                            struct glint_error *err) {
    VkShaderModuleCreateInfo module_info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    uint32_t *words = words_of(gpu, from, &module_info.codeSize);
    if (!words) return glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", name);
    module_info.pCode = words;
    VkShaderModule module;
    const bool made = gpu_ok(gpu, vkCreateShaderModule(gpu->device, &module_info, NULL, &module), name, err);
    free(words);
    if (!made) return false;
    device_set_name(gpu, VK_OBJECT_TYPE_SHADER_MODULE, (uint64_t)(uintptr_t)module, name);
    const VkSpecializationInfo values = {constants->count, constants->entries, constants->count * sizeof(uint32_t),
                                         constants->data};
    const VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                              .flags = some_layers ? VK_PIPELINE_CREATE_DISPATCH_BASE : 0,
                                              .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                        .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                        .module = module,
                                                        .pName = "main",
                                                        .pSpecializationInfo = &values},
                                              .layout = program->layout};
    const bool ok =
        from.foreign
            ? pipeline_create_patiently(gpu, &info, constants, name, &program->pipeline, err)
            : gpu_ok(gpu, vkCreateComputePipelines(gpu->device, gpu->cache, 1, &info, NULL, &program->pipeline), name,
                     err);
    GPU_DESTROY(gpu, vkDestroyShaderModule, module);
    if (ok) device_set_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)(uintptr_t)program->pipeline, name);
    return ok;
}

/* The pass's module that reads parameters from memory, made once; NULL: out of memory. */
static const struct generic *find_generic(struct programs *programs, const struct glint_pass *pass, struct module from,
                                          const struct constants *constants) {
    struct generic *found = programs->generic;
    while (found && (found->pass != pass || found->from != from.words)) found = found->next;
    if (found) return found;
    uint32_t ids[SPIRV_PLACES] = {0};
    for (uint32_t i = 0; i < constants->count; i++) ids[i] = constants->entries[i].constantID;
    if (!(found = calloc(1, sizeof *found))) return NULL;
    *found = (struct generic){.pass = pass, .from = from.words, .next = programs->generic};
    found->words = spirv_generic(from.words, from.bytes, ids, constants->parameters, &found->turned, &found->bytes);
    if (found->words) return programs->generic = found;
    free(found);
    return NULL;
}

/* Finds a program and moves it to the front of the list, which is in order of last use; drops what was not used for long. */
static struct program *find_program(struct programs *programs, struct gpu *gpu, uint64_t key) {
    enum { KEPT = 256 };
    size_t count = 0;
    for (struct program **at = &programs->first; *at; at = &(*at)->next, count++) {
        struct program *found = *at;
        if (found->key == key) {
            *at = found->next;
            found->next = programs->first;
            return programs->first = found;
        }
        if (count == KEPT) {
            for (struct program *old = found->next, *next; old; old = next) {
                next = old->next;
                program_destroy(old, gpu);
            }
            found->next = NULL;
        }
    }
    return NULL;
}

static uint64_t program_key(const struct glint_pass *pass, const struct constants *constants, uint64_t module) {
    char name[128];
    snprintf(name, sizeof name, "%s/%s", pass->slot, pass->variant);
    return XXH3_64bits_withSeed(constants->data, constants->count * sizeof(uint32_t), module) ^
           XXH3_64bits(name, strlen(name));
}

static struct program *add_program(struct programs *programs, struct gpu *gpu, const struct glint_pass *pass,
                                   struct module from, const struct constants *constants, uint64_t key, bool generic,
                                   struct glint_error *err) {
    char name[128];
    snprintf(name, sizeof name, "%s/%s", pass->slot, pass->variant);
    struct program *program = calloc(1, sizeof *program);
    if (!program) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", name);
        return NULL;
    }
    program->key = key;
    program->generic = generic;
    programs->compiled++;
    if (!create_layouts(program, gpu, programs, pass, constants, name, err) ||
        !create_pipeline(program, gpu, from, constants, glint_pass_row(pass, GLINT_ROW_RAY_MARGIN, NULL), name, err)) {
        program_destroy(program, gpu);
        return NULL;
    }
    program->next = programs->first;
    return programs->first = program;
}

struct program *programs_get(struct programs *programs, struct gpu *gpu, const struct glint_pass *pass,
                             const struct spirv *spirv, const struct constants *constants, bool quick,
                             struct glint_error *err) {
    const uint64_t key = program_key(pass, constants, spirv->hash);
    const struct module from = module_of(gpu, spirv, constants);
    struct program *program = find_program(programs, gpu, key);
    if (program) return program;
    const struct generic *generic = quick ? find_generic(programs, pass, from, constants) : NULL;
    if (quick && !generic) {
        glint_fail(err, GLINT_ERROR_MEMORY, "%s/%s: out of memory", pass->slot, pass->variant);
        return NULL;
    }
    if (!generic || !generic->turned) return add_program(programs, gpu, pass, from, constants, key, false, err);
    struct constants left = *constants;
    for (uint32_t i = 0; i < left.count; i++)
        if (generic->turned >> i & 1) left.data[i] = 0;
    const uint64_t shared = program_key(pass, &left, ~spirv->hash);
    if ((program = find_program(programs, gpu, shared))) return program;
    return add_program(programs, gpu, pass, (struct module){generic->words, generic->bytes, from.foreign}, &left,
                       shared, true, err);
}
