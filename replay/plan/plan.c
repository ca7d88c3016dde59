/* The plan: facts about the frame, the graph that follows from them, and its sizes. */
#include "planner.h"

struct fact_source {
    struct planner *planner;
    const struct glint_pipeline *pipeline;
    const struct glint_replay_options *options;
};

void planner_load(struct planner *planner) {
    struct survey_state *survey = &planner->survey;
    const struct glint_capture *capture = planner->source->capture;
    survey->done = false;
    survey->figures = (struct glint_survey){0};
    if (!capture) return;
    survey_capture_parts(capture, &survey->figures);
    survey->figures.has_history = !glint_capture_frame(capture)->cut && pool_has_history(planner->pool);
}

static bool fact_holds(void *user, const char *fact, char *reason, size_t size, struct glint_error *err) {
    const struct fact_source *source = user;
    const enum fact_about about = survey_fact_about(fact);
    const bool of_parts = about == FACT_PARTS || about == FACT_CUBEMAPS || about == FACT_FACES;
    return (of_parts || planner_survey(source->planner, source->pipeline, source->options, false, err)) &&
           survey_fact(&source->planner->survey.figures, pipeline_shows_all(source->pipeline), fact, reason, size);
}

/* Which passes run. What the cube maps show is looked at only where a pass that runs asks for it, and then all is decided
   again. */
static bool decide_passes(struct frame_plan *plan, struct planner *planner, const struct graph_inputs *inputs,
                          struct glint_error *err) {
    struct glint_survey *figures = &planner->survey.figures;
    if (plan->options->all) return graph_decide(&plan->graph, inputs, err);
    const uint32_t before = figures->looked_at;
    figures->looked_at = figures->followed = 0; /* not at this pipeline's cube maps */
    if (!graph_decide(&plan->graph, inputs, err)) return false;
    if (plan->graph.faults.count > 0) return true; /* linking reports them */
    return survey_cubemaps(planner, plan, before, err) &&
           (figures->looked_at == 0 || graph_decide(&plan->graph, inputs, err));
}

bool plan_frame(struct frame_plan *plan, struct planner *planner, const struct glint_pipeline *pipeline,
                const struct glint_replay_options *options, bool run, struct glint_error *err) {
    plan_begin(plan, planner, pipeline, options);
    struct glint_capture *capture = planner->source->capture;
    if (!capture) return glint_fail(err, GLINT_ERROR_USAGE, "no capture is loaded");
    if (options->inputs && !(plan->inputs = glint_run_open(options->inputs, err))) return false;
    if (options->history && !glint_capture_frame(capture)->cut) planner->survey.figures.has_history = true;
    struct fact_source source = {planner, pipeline, options};
    const struct graph_inputs inputs = {options, capture, plan->inputs, {fact_holds, survey_fact_about, &source}};
    if (!graph_init(&plan->graph, pipeline, err) || !decide_passes(plan, planner, &inputs, err)) return false;
    if (run) return plan_complete(plan, planner, &inputs, err) && plan_workload(plan, &inputs, true, err);
    if (!graph_link(&plan->graph, &inputs, err)) return false;
    struct glint_error ignored = {0}; /* what cannot be run may be planned */
    const bool sized =
        tables_fill(plan->tables, &plan->graph, plan->source, &ignored) && plan_find_sizes(plan, &ignored);
    return (!sized || plan_reach(plan, &planner->survey.figures, err)) && plan_workload(plan, &inputs, sized, err);
}
