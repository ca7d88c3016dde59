/* Completes a plan whose passes are decided: images, tables, sizes, uniform block. */
#include <math.h>
#include <string.h>

#include "planner.h"

void plan_begin(struct frame_plan *plan, const struct planner *planner, const struct glint_pipeline *pipeline,
                const struct glint_replay_options *options) {
    *plan = (struct frame_plan){.pipeline = pipeline,
                                .options = options,
                                .source = planner->source,
                                .tables = &plan->own_tables,
                                .is_cpu = !planner->engine || planner->engine->gpu->info.is_cpu};
}

/* Without cube maps, the picture alone tells whether rays that leave the screen may reach the sky. A plan changes no bit, so it is counted whether
   or not passes are left out. */
static bool find_openness(struct frame_plan *plan, struct planner *planner, struct glint_error *err) {
    const struct glint_survey *figures = &planner->survey.figures;
    if (plan->interim || !planner->engine || plan->sizes.active > 0 || !figures->has_sky) return true;
    if (!planner_survey(planner, plan->pipeline, plan->options, false, err)) return false;
    plan->block.openness.x = figures->above ? (float)((double)figures->open / (double)figures->above) : -1;
    return true;
}

static void fill_frame_block(struct frame_plan *plan) {
    const struct glint_frame *frame = glint_capture_frame(plan->source->capture);
    const struct glint_part_info *mirror = glint_capture_find(plan->source->capture, GLINT_PART_MIRROR);
    float classes[2];
    uint32_t lamps[LAMPS];
    frame_block_fill(&plan->block, frame, &plan->sizes);
    plan->block.flags.w = plan->pipeline->first_ray;
    plan->block.up.w = plan->options->float_precision ? INFINITY : HALF_LARGEST;
    plan->block.work = (uvec4){plan->options->all, pipeline_shows_all(plan->pipeline), 0, 0};
    pipeline_classes(plan->pipeline, &classes[0], &classes[1]);
    memcpy(&plan->block.work.z, classes, sizeof classes);
    frame_block_captured_light(&plan->block, plan->source->capture);
    frame_block_far(&plan->block, plan->source->capture);
    frame_block_grid(&plan->block, frame, glint_capture_find(plan->source->capture, PART_GRID));
    frame_block_froxels(&plan->block, frame, glint_capture_find(plan->source->capture, PART_FROXELS));
    for (uint32_t i = 0; plan->active && i < plan->sizes.active; i++)
        if (glint_part_has_channel(plan->source->cubemaps[plan->active[i]], "distance.Z"))
            plan->block.distances.x |= 1U << i;
    if (mirror) frame_block_mirror(&plan->block, frame, &mirror->planar);
    frame_block_lamps(&plan->block, frame, lamps);
    frame_block_shadows(&plan->block, plan->source->capture, lamps);
}

bool plan_complete(struct frame_plan *plan, struct planner *planner, const struct graph_inputs *inputs,
                   struct glint_error *err) {
    const struct glint_replay_options *options = plan->options;
    if (!graph_link(&plan->graph, inputs, err) || !tables_fill(plan->tables, &plan->graph, plan->source, err) ||
        !plan_find_sizes(plan, err) || !plan_history(plan, planner->pool, err) ||
        !plan_reach(plan, &planner->survey.figures, err))
        return false;
    fill_frame_block(plan);
    if (!find_openness(plan, planner, err)) return false;
    if (options->cache && !frame_source_hash(plan->source, plan->content, NULL)) plan->content[0] = 0;
    return true;
}
