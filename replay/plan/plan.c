/* Plans a frame: builds the graph, evaluates facts by the survey, decides which passes run, completes the plan. */
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
    const bool needs_no_pixels = about == FACT_PARTS || about == FACT_CUBEMAPS || about == FACT_FACES;
    return (needs_no_pixels || planner_survey(source->planner, source->pipeline, source->options, false, err)) &&
           survey_fact(&source->planner->survey.figures, pipeline_shows_all(source->pipeline), fact, reason, size);
}

/* Decides which passes run. Cube maps are surveyed only if a running pass depends on their contents, and then all passes are decided again. */
static bool decide_passes(struct frame_plan *plan, struct planner *planner, const struct graph_inputs *inputs,
                          struct glint_error *err) {
    struct glint_survey *figures = &planner->survey.figures;
    if (plan->options->all) return graph_decide(&plan->graph, inputs, err);
    const uint32_t before = figures->active_surveyed;
    figures->active_surveyed = figures->active_traced = 0; /* this pipeline may have other active cube maps */
    if (!graph_decide(&plan->graph, inputs, err)) return false;
    if (plan->graph.faults.count > 0) return true; /* linking reports them */
    return survey_cubemaps(planner, plan, before, err) &&
           (figures->active_surveyed == 0 || graph_decide(&plan->graph, inputs, err));
}

bool plan_frame(struct frame_plan *plan, struct planner *planner, const struct glint_pipeline *pipeline,
                const struct glint_replay_options *options, bool run, struct glint_error *err) {
    plan_begin(plan, planner, pipeline, options);
    struct glint_capture *capture = planner->source->capture;
    if (!capture) return glint_fail(err, GLINT_ERROR_USAGE, "no capture is loaded");
    planner_renew(planner, pipeline, options);
    if (options->inputs && !(plan->inputs = glint_run_open(options->inputs, err))) return false;
    if (options->history && !glint_capture_frame(capture)->cut) planner->survey.figures.has_history = true;
    struct fact_source source = {planner, pipeline, options};
    const struct graph_inputs inputs = {options, capture, plan->inputs, {fact_holds, survey_fact_about, &source}};
    if (!graph_init(&plan->graph, pipeline, err) || !decide_passes(plan, planner, &inputs, err)) return false;
    if (run) return plan_complete(plan, planner, &inputs, err) && plan_workload(plan, &inputs, true, err);
    if (!graph_link(&plan->graph, &inputs, err)) return false;
    struct glint_error ignored = {0}; /* a plan may also be made of a pipeline that cannot run */
    const bool sized =
        tables_fill(plan->tables, &plan->graph, plan->source, &ignored) && plan_find_sizes(plan, &ignored);
    if (!sized && ignored.code == GLINT_ERROR_MEMORY) return glint_fail(err, ignored.code, "%s", ignored.message);
    return (!sized || plan_reach(plan, &planner->survey.figures, err)) && plan_workload(plan, &inputs, sized, err);
}
