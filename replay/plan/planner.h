/* Plans: which passes a frame calls for, of which sizes, over which faces. The planner is a client of the engine, which
   runs what the survey counts with; the engine knows nothing of plans to come. */
#ifndef GLINT_REPLAY_PLANNER_H
#define GLINT_REPLAY_PLANNER_H

#include "run.h"
#include "survey.h"

struct planner {
    struct frame_source *source;
    struct pool *pool;
    struct engine *engine; /* NULL: no device */
    struct survey_state survey;
};
/* Another frame was loaded. */
void planner_load(struct planner *planner);
/* Plans a frame. `run`: it will be run, else it is only to be looked at. The plan stays where it is, and is to be finished
   whether that failed or not. */
bool plan_frame(struct frame_plan *plan, struct planner *planner, const struct glint_pipeline *pipeline,
                const struct glint_replay_options *options, bool run, struct glint_error *err);

/* survey_device.c. The figures of the loaded frame, counted unless they are known. `whole`: with those that no plan asks for. */
bool planner_survey(struct planner *planner, const struct glint_pipeline *pipeline,
                    const struct glint_replay_options *options, bool whole, struct glint_error *err);
/* Runs the pass of the survey that makes a figure, after `before` (NULL: none), on the tables of a plan (NULL: none). Returns the
   texels of its images, one after the other; the caller frees them. */
uint32_t *survey_run(struct planner *planner, const struct pipeline_pass *before, struct tables *tables,
                     const enum glint_pass_role *figures, size_t figure_count, double value,
                     const struct glint_replay_options *wanted, struct glint_time *time, struct glint_error *err);

/* survey_cubemaps.c: looks at the active cube maps when a pass that runs asks what they show: then the graph has to be decided
   anew. `before`: how many the survey knows of from the last plan. */
bool survey_cubemaps(struct planner *planner, struct frame_plan *plan, uint32_t before, struct glint_error *err);

/* complete.c. A plan of nothing yet; and all of a plan but its passes, when graph_decide is done. */
void plan_begin(struct frame_plan *plan, const struct planner *planner, const struct glint_pipeline *pipeline,
                const struct glint_replay_options *options);
bool plan_complete(struct frame_plan *plan, struct planner *planner, const struct graph_inputs *inputs,
                   struct glint_error *err);

/* history.c: what is left of the frame before. */
bool plan_history(struct frame_plan *plan, const struct pool *pool, struct glint_error *err);

/* reach.c: faces that rays come to. */
bool plan_reach(struct frame_plan *plan, const struct glint_survey *survey, struct glint_error *err);
bool graph_follows_rays(const struct graph *graph, const char *image);

/* workload.c: what each pass works on when nothing is left out, and faces of cube maps, with and without. `sized`: sizes and
   reach are known. */
bool plan_workload(struct frame_plan *plan, const struct graph_inputs *inputs, bool sized, struct glint_error *err);

#endif
