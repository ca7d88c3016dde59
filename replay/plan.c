/* The plan: facts about the frame, and the graph that follows from them. */
#include "state.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "timing.h"

struct fact_source {
    struct glint_replay *replay;
    const struct glint_pipeline *pipeline;
    const struct glint_replay_options *options;
};

static bool pass_reads(const struct glint_pass *pass, const struct glint_row *image) {
    for (size_t r = 0; pass && r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_READ && strcmp(pass->rows[r].name, image->name) == 0) return true;
    return false;
}

/* The G-buffer is read once: what the survey needs together with what the passes will. */
static bool read_gbuffer(struct glint_replay *replay, const struct glint_pipeline *pipeline, struct glint_error *err) {
    struct channels *gbuffer = &replay->gbuffer;
    size_t count;
    const struct glint_row *rows = glint_capture_images(&count);
    channels_finish(gbuffer);
    gbuffer->part = glint_capture_find(replay->capture, "gbuffer");
    if (!gbuffer->part)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing", glint_capture_path(replay->capture));
    if (!channels_add_survey(gbuffer, err)) return false;
    for (size_t i = 0; i < count; i++) {
        if (strcmp(rows[i].role, "gbuffer") != 0) continue;
        bool read = replay->device && pass_reads(survey_pass(), &rows[i]);
        for (size_t p = 0; p < pipeline->count; p++) read |= pass_reads(pipeline->passes[p].pass, &rows[i]);
        size_t before = gbuffer->count;
        if (read && !format_is_uint(rows[i].format) && !channels_add_row(gbuffer, &rows[i], err)) return false;
        for (size_t c = before; c < gbuffer->count; c++)
            if (!glint_part_has_channel(gbuffer->part, gbuffer->names[c])) { /* optional, or the graph reports it */
                while (gbuffer->count > before) free((char *)gbuffer->names[--gbuffer->count]);
            }
    }
    return channels_read(gbuffer, replay->capture, err);
}

/* `whole`: with what no plan asks for. */
static bool survey(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                   const struct glint_replay_options *options, bool whole, struct glint_error *err) {
    if (replay->surveyed && !(whole && replay->survey.brief)) return true;
    double start = now_seconds();
    replay->survey_time = (struct glint_time){0};
    if (!read_gbuffer(replay, pipeline, err)) {
        channels_finish(&replay->gbuffer);
        return false;
    }
    replay->seconds[PHASE_READ] += now_seconds() - start;
    if (!replay->device || !glint_capture_find(replay->capture, "lit"))
        survey_channels(&replay->gbuffer, &replay->survey);
    else if (!survey_on_device(replay, options, whole, err)) return false;
    replay->surveyed = true;
    return true;
}

static bool holds(void *user, const char *fact, char *reason, size_t size, bool *known, struct glint_error *err) {
    struct fact_source *source = user;
    return (fact_is_of_parts(fact) || survey(source->replay, source->pipeline, source->options, false, err)) &&
           survey_fact(&source->replay->survey, pipeline_shows_all(source->pipeline), fact, reason, size, known);
}

bool glint_replay_survey(struct glint_replay *replay, const struct glint_survey **found, struct glint_time *time,
                         struct glint_error *err) {
    static const struct glint_pipeline nothing;
    static const struct glint_replay_options defaults;
    if (!replay->capture) return glint_fail(err, GLINT_ERROR_USAGE, "no capture is loaded");
    const bool ok = survey(replay, &nothing, &defaults, true, err);
    channels_finish(&replay->gbuffer);
    *found = &replay->survey;
    if (time) *time = replay->survey_time;
    return ok;
}

bool replay_graph(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                  const struct glint_replay_options *options, const struct glint_run *inputs, struct graph *graph,
                  struct glint_error *err) {
    if (!replay->capture) return glint_fail(err, GLINT_ERROR_USAGE, "no capture is loaded");
    if (options->history && !glint_capture_frame(replay->capture)->cut) replay->survey.has_history = true;
    struct fact_source source = {replay, pipeline, options};
    const struct graph_inputs graph_inputs = {pipeline, options, replay->capture, inputs, {holds, &source}};
    if (options->all || replay->surveying) return graph_init(graph, &graph_inputs, err);
    const uint32_t before = replay->survey.looked_at;
    replay->survey.looked_at = replay->survey.followed = 0; /* not at this pipeline's cube maps */
    if (!graph_init(graph, &graph_inputs, err)) return false;
    if (survey_cubemaps(replay, pipeline, graph, options, before, err) && replay->survey.looked_at == 0) return true;
    graph_finish(graph);
    return replay->survey.looked_at > 0 && graph_init(graph, &graph_inputs, err);
}

bool glint_replay_plan(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                       const struct glint_replay_options *options, const struct glint_plan_entry **entries,
                       size_t *count, struct glint_error *err) {
    static const struct glint_replay_options defaults;
    struct graph graph = {0};
    struct glint_run *inputs = NULL;
    struct whole_work *work = NULL;
    bool ok = false;
    if (!options) options = &defaults;
    if (options->inputs && !(inputs = glint_run_open(options->inputs, err))) return false;
    if (!replay_graph(replay, pipeline, options, inputs, &graph, err)) goto done;
    free(replay->plan);
    replay->plan = calloc(graph.pass_count + 1, sizeof *replay->plan);
    if (!replay->plan) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        goto done;
    }
    work = calloc(graph.pass_count + 1, sizeof *work);
    if (!work) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        goto done;
    }
    replay_whole_work(replay, pipeline, options, inputs, work);
    replay_count_faces(replay, pipeline, options, inputs, &graph);
    for (size_t i = 0; i < graph.pass_count; i++) {
        replay->plan[i] = (struct glint_plan_entry){.pass = graph.passes[i].pass,
                                                    .runs = graph.passes[i].runs,
                                                    .cached_work = work[i].cached_work,
                                                    .texels = work[i].texels};
        memcpy(replay->plan[i].reason, graph.passes[i].reason, sizeof replay->plan[i].reason);
    }
    *entries = replay->plan;
    *count = graph.pass_count;
    ok = true;
done:
    free(work);
    channels_finish(&replay->gbuffer);
    graph_finish(&graph);
    glint_run_close(&inputs);
    return ok;
}
