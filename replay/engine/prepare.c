/* Creates what is needed before passes can be recorded: programs, descriptors, queries. */
#include "run.h"

#include <stdlib.h>
#include <string.h>

static bool prepare_frame_set(struct run *run, struct glint_error *err) {
    struct engine *engine = run->engine;
    if (!descriptors_allocate(run->gpu, run->descriptors, &engine->device->programs.frame, "frame", &run->frame_set,
                              err))
        return false;
    memcpy(engine->frame.map, &run->plan->block, sizeof run->plan->block);
    descriptor_set_buffer(run->gpu, run->frame_set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &engine->frame,
                          sizeof run->plan->block);
    descriptor_set_buffer(run->gpu, run->frame_set, 3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &engine->probes,
                          VK_WHOLE_SIZE);
    return true;
}

/* Each step has a slot in the buffer, at its place in the graph. */
static bool prepare_values(struct run *run, struct glint_error *err) {
    struct host_buffer *values = &run->engine->values;
    const size_t count = run->graph->pass_count;
    if (values->size < count * VALUES_BYTES) {
        host_buffer_finish(values, run->gpu);
        if (!host_buffer_init(values, run->gpu, HOST_BUFFER_UNIFORM, count * VALUES_BYTES, "values", err)) return false;
    }
    if (!descriptors_allocate(run->gpu, run->descriptors, &run->engine->device->programs.values, "values",
                              &run->values_set, err))
        return false;
    for (size_t p = 0; p < count; p++)
        memcpy((char *)values->map + p * VALUES_BYTES, run->steps[p].constants.data, VALUES_BYTES);
    descriptor_set_buffer(run->gpu, run->values_set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, values,
                          VALUES_BYTES);
    return true;
}

static bool prepare_queries(struct run *run, struct glint_error *err) {
    if (!run->gpu->timestamp_mask || !run->graph->pass_count) return true;
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = (uint32_t)run->graph->pass_count + 1};
    return gpu_ok(run->gpu, vkCreateQueryPool(run->gpu->device, &info, NULL, &run->queries),
                  "creating timestamp queries", err);
}

static bool find_programs(const struct run *run, struct step *step, struct glint_error *err) {
    struct constants constants = step->constants;
    for (size_t d = 0; d < step->dispatch_count; d++) {
        struct dispatch *dispatch = &step->dispatches[d];
        constants.data[CONSTANT_PHASE] = dispatch->phase;
        constants.data[PLACE_TILES] = dispatch->range;
        constants.data[PLACE_WORKS] = !dispatch->rest;
        dispatch->program = programs_get(&run->engine->device->programs, run->gpu, step->pass->pass, &step->spirv,
                                         &constants, run->options->quick, err);
        if (!dispatch->program) return false;
        step->quick |= dispatch->program->generic;
    }
    return true;
}

bool run_prepare(struct run *run, struct glint_error *err) {
    const struct graph *graph = run->graph;
    uint32_t sets = 1, images = 0;
    bool quick = false;
    for (size_t p = 0; p < graph->pass_count; p++) {
        struct step *step = &run->steps[p];
        const struct glint_pass *pass = graph->passes[p].pass;
        if (!graph->passes[p].runs || pass->host) continue;
        if (!step_plan(run, step, err)) return false;
        if (!step->execute) continue;
        if (!find_programs(run, step, err)) return false;
        quick |= step->quick;
        sets += (uint32_t)step->dispatch_count;
        for (size_t r = 0; r < pass->row_count; r++)
            images += (uint32_t)step->dispatch_count * row_bindings(&pass->rows[r]);
    }
    const uint32_t sums = rays_sums(run);
    if (!descriptors_create(run->gpu, sets + sums + quick, images + 2 * sums + 1, quick, &run->descriptors, err))
        return false;
    for (size_t p = 0; p < graph->pass_count; p++)
        if (run->steps[p].execute && !step_describe(run, &run->steps[p], err)) return false;
    if (quick && !prepare_values(run, err)) return false;
    return prepare_frame_set(run, err) && prepare_queries(run, err) && rays_prepare(run, sums, err);
}
