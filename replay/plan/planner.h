/* The planner decides which passes run, in which sizes and over which cube-map faces. It uses the engine to run the passes of the survey; the
   engine does not depend on the planner. */
#ifndef GLINT_REPLAY_PLANNER_H
#define GLINT_REPLAY_PLANNER_H

#include "run.h"
#include "survey.h"

struct planner {
    struct frame_source *source;
    struct pool *pool;
    struct engine *engine; /* NULL without a device */
    struct survey_state survey;
};
/* Call it when another frame was loaded. */
void planner_load(struct planner *planner);
/* Plans a frame, completely if it is to be `run`. The plan must not be moved. Call frame_plan_finish in any case. */
bool plan_frame(struct frame_plan *plan, struct planner *planner, const struct glint_pipeline *pipeline,
                const struct glint_replay_options *options, bool run, struct glint_error *err);

/* missing.c: what the passes of a linked plan would read and the capture does not have. */
enum { MISSING_MAX = 64 };
size_t plan_missing(const struct frame_plan *plan, const struct glint_absence *missing[MISSING_MAX]);

/* survey_device.c: forgets figures that another pipeline's passes have changed, or that those of this one will change. */
void planner_renew(struct planner *planner, const struct glint_pipeline *pipeline,
                   const struct glint_replay_options *options);
/* survey_device.c: counts the figures of the loaded frame unless they are known, with `whole` also those that no plan depends on. */
bool planner_survey(struct planner *planner, const struct glint_pipeline *pipeline,
                    const struct glint_replay_options *options, bool whole, struct glint_error *err);
/* Runs the survey's pass that has the roles `figures`, after the pass `before` (may be NULL), with the tables of a plan (may be NULL). Returns
   the texels of the images of these roles, one image after the other; the caller frees them. */
uint32_t *survey_run(struct planner *planner, const struct pipeline_pass *before, struct tables *tables,
                     const enum glint_pass_role *figures, size_t figure_count, double value,
                     const struct glint_replay_options *caller, struct glint_time *time, struct glint_error *err);

/* survey_cubemaps.c: surveys the active cube maps if a running pass depends on their contents; the graph must then be decided again. `before` is
   active_surveyed of the last plan. */
bool survey_cubemaps(struct planner *planner, struct frame_plan *plan, uint32_t before, struct glint_error *err);

/* complete.c: initialises a plan; completes it after graph_decide. */
void plan_begin(struct frame_plan *plan, const struct planner *planner, const struct glint_pipeline *pipeline,
                const struct glint_replay_options *options);
bool plan_complete(struct frame_plan *plan, struct planner *planner, const struct graph_inputs *inputs,
                   struct glint_error *err);

/* history.c: finds images of the previous frame. */
bool plan_history(struct frame_plan *plan, const struct pool *pool, struct glint_error *err);

/* reach.c: which passes and uploads can be limited to the faces that rays reach. */
bool plan_reach(struct frame_plan *plan, const struct glint_survey *survey, struct glint_error *err);
/* Whether all running passes sample the image only along rays whose paths the survey knows. */
bool graph_is_along_rays(const struct graph *graph, const char *image);

/* workload.c: counts the work of each pass without culling, and cube-map faces with and without it. `sized`: sizes and reach are known. */
bool plan_workload(struct frame_plan *plan, const struct graph_inputs *inputs, bool sized, struct glint_error *err);

#endif
