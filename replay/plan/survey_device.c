/* Counts the survey's figures on the device, by a pass over the capture's images. These stay on the device for the run that follows. */
#include "planner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum place {
#define COUNT(name, bins, meaning) at_##name = 16 * __LINE__,
#define MINIMUM(name, meaning) COUNT(name, 1, meaning)
#define MAXIMUM(name, meaning) COUNT(name, 1, meaning)
#line 1
#include "survey/figures.h"
#undef COUNT
#undef MINIMUM
#undef MAXIMUM
};

static float as_float(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void copy_bins(uint64_t *bins, const uint32_t *figures, size_t count) {
    for (size_t i = 0; i < count; i++) bins[i] = figures[i];
}

static void set_range(float range[2], const uint32_t *figures, enum place least, enum place most, bool any) {
    range[0] = any ? as_float(figures[least]) : INFINITY;
    range[1] = any ? as_float(figures[most]) : -INFINITY;
}

static void read_figures(struct glint_survey *survey, const uint32_t *f, bool whole) {
    survey->sky = f[at_sky];
    survey->surfaces.count = f[at_surfaces];
    survey->reflecting.count = f[at_reflecting];
    survey->pixels = survey->sky + survey->surfaces.count;
    survey->above = f[at_above];
    survey->open = f[at_open];
    survey->sunlit = f[at_sunlit];
    survey->luminous = f[at_luminous];
    survey->lamplit = f[at_lamplit];
    survey->stippled = f[at_stippled];
    survey->skin = f[at_skin];
    survey->water = f[at_water];
    survey->transparent = f[at_transparent];
    survey->moved = f[at_moved];
    survey->moving = f[at_moving];
    copy_bins(survey->surfaces.by_roughness, f + at_surface_roughness, GLINT_SURVEY_BINS);
    copy_bins(survey->reflecting.by_roughness, f + at_reflecting_roughness, GLINT_SURVEY_BINS);
    copy_bins(survey->metalness, f + at_metalness, GLINT_SURVEY_BINS);
    copy_bins(survey->weight, f + at_weight, GLINT_SURVEY_WEIGHTS);
    copy_bins(survey->stencil_bits, f + at_stencil_bits, 8);
    set_range(survey->surfaces.roughness, f, at_surface_smoothest, at_surface_roughest, survey->surfaces.count > 0);
    set_range(survey->reflecting.roughness, f, at_reflecting_smoothest, at_reflecting_roughest,
              survey->reflecting.count > 0);
    set_range(survey->depth_m, f, at_nearest, at_farthest, whole && survey->surfaces.count > 0);
    set_range(survey->light, f, at_darkest, at_brightest, whole && f[at_darkest] <= f[at_brightest]);
    survey->light[1] = as_float(f[at_brightest]);
    survey->transparent_roughness = as_float(f[at_transparent_roughest]);
    survey->on_device = true;
    survey->partial = !whole;
}

/* Reads images into one array, one after the other. */
static uint32_t *read_images(struct pool *pool, const char *const *names, struct glint_error *err) {
    uint32_t *values = NULL;
    size_t count = 0;
    for (; *names; names++) {
        const struct glint_image *image = pool_find(pool, *names);
        const size_t more = (size_t)image->width * image->height;
        uint32_t *larger = realloc(values, (count + more) * sizeof *values);
        if (larger) values = larger;
        else glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", *names);
        if (!larger || !pool_read_image(pool, image, GLINT_U32, values + count, err)) {
            free(values);
            return NULL;
        }
        count += more;
    }
    return values;
}

static uint32_t *run_and_read(struct planner *planner, const struct frame_plan *plan, struct glint_time *time,
                              struct glint_error *err) {
    struct run run;
    uint32_t *values = engine_run(&run, planner->engine, plan, NULL, NULL, err)
                           ? read_images(planner->pool, plan->options->outputs, err)
                           : NULL;
    for (size_t p = 0; values && p < plan->graph.pass_count; p++)
        if (run.steps[p].execute) *time = glint_time_statistics(run.steps[p].ns, run.steps[p].timed);
    time->cold = time->n && !plan->options->repeat;
    engine_release(&run);
    return values;
}

enum { FIGURES_MAX = 2, VALUES_MAX = 64 };
uint32_t *survey_run(struct planner *planner, const struct pipeline_pass *before, struct tables *tables,
                     const enum glint_pass_role *figures, size_t figure_count, double value,
                     const struct glint_replay_options *caller, struct glint_time *time, struct glint_error *err) {
    double values[VALUES_MAX];
    const char *outputs[FIGURES_MAX + 1] = {NULL}, *force[3] = {NULL};
    struct pipeline_pass passes[2] = {{0}};
    size_t count = 0;
    if (before) passes[count++] = *before;
    for (size_t i = 0; i < figure_count; i++) passes[count].pass = glint_pass_with_role(figures[i], &outputs[i]);
    for (size_t r = 0; r < VALUES_MAX; r++) values[r] = value;
    passes[count++].values = values;
    for (size_t i = 0; i < count; i++) force[i] = passes[i].pass->slot;
    const struct glint_pipeline pipeline = {
        .name = (char *)passes[count - 1].pass->slot, .passes = passes, .count = count};
    const struct glint_replay_options options = {.outputs = outputs,
                                                 .force = force,
                                                 .repeat = caller->repeat,
                                                 .warmup = caller->warmup,
                                                 .no_cache = true,
                                                 .lineage = UINT32_MAX};
    const struct graph_inputs inputs = {.options = &options, .capture = planner->source->capture};
    struct frame_plan plan;
    plan_begin(&plan, planner, &pipeline, &options);
    plan.interim = true;
    if (tables) plan.tables = tables;
    uint32_t *found = graph_init(&plan.graph, &pipeline, err) && graph_decide(&plan.graph, &inputs, err) &&
                              plan_complete(&plan, planner, &inputs, err)
                          ? run_and_read(planner, &plan, time, err)
                          : NULL;
    frame_plan_finish(&plan);
    return found;
}

static bool pass_reads(const struct glint_pass *pass, const struct glint_row *image) {
    return pass && glint_pass_row(pass, GLINT_ROW_READ, image->name);
}

/* The pass that counts; NULL without a device or if the capture lacks a part that the pass reads. The host then counts fewer figures. */
static const struct glint_pass *counting_pass(const struct planner *planner) {
    const char *image;
    const struct glint_pass *pass = planner->engine ? glint_pass_with_role(GLINT_ROLE_SURVEY_FIGURES, &image) : NULL;
    for (size_t r = 0; pass && r < pass->row_count; r++) {
        const struct glint_row *row = pass->rows[r].kind == GLINT_ROW_READ ? capture_row(pass->rows[r].name) : NULL;
        if (row && row->required && !glint_capture_find(planner->source->capture, row->role)) return NULL;
    }
    return pass;
}

/* Reads the G-buffer once, with the channels that the survey needs and those that the passes will read. */
static bool read_gbuffer(struct planner *planner, const struct glint_pipeline *pipeline, struct glint_error *err) {
    struct glint_capture *capture = planner->source->capture;
    struct channels *gbuffer = &planner->source->gbuffer;
    const char *figures;
    const struct glint_pass *counting =
        planner->engine ? glint_pass_with_role(GLINT_ROLE_SURVEY_FIGURES, &figures) : NULL;
    size_t count;
    const struct glint_row *rows = glint_capture_images(&count);
    channels_finish(gbuffer);
    gbuffer->part = glint_capture_find(capture, GLINT_PART_GBUFFER);
    if (!gbuffer->part)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing", glint_capture_path(capture));
    if (!channels_add_survey(gbuffer, err)) return false;
    for (size_t i = 0; i < count; i++) {
        if (strcmp(rows[i].role, gbuffer->part->name) != 0) continue;
        bool read = pass_reads(counting, &rows[i]);
        for (size_t p = 0; p < pipeline->count; p++) read |= pass_reads(pipeline->passes[p].pass, &rows[i]);
        const size_t before = gbuffer->count;
        if (read && !glint_format_is_uint(rows[i].format) && !channels_add_row(gbuffer, &rows[i], err)) return false;
        for (size_t c = before; c < gbuffer->count; c++) /* it is optional, or linking reports that it is missing */
            if (!glint_part_can_read(gbuffer->part, gbuffer->names[c])) channels_keep(gbuffer, before);
    }
    return channels_read(gbuffer, capture, err);
}

/* Whether the pass makes an image in place of the capture's own, for which the capture has a part beside the G-buffer. */
static bool changes_capture(const struct glint_pass *pass, const struct glint_capture *capture) {
    bool makes = false, has = false;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r], *image = capture_row(row->name);
        if (glint_row_is_output(row)) makes |= image != NULL;
        else if (row->kind == GLINT_ROW_READ && image && strcmp(image->role, GLINT_PART_GBUFFER) != 0)
            has |= graph_capture_has(capture, image);
    }
    return makes && has;
}

/* The pass of the pipeline that does so and will run, or NULL: the survey counts what it makes. */
static const struct pipeline_pass *changing_pass(const struct planner *planner, const struct glint_pipeline *pipeline,
                                                 const struct glint_replay_options *options) {
    for (size_t p = 0; planner->engine && p < pipeline->count; p++) {
        const char *slot = pipeline->passes[p].pass->slot;
        const bool runs = !list_has(options->skip, slot) && (!options->passes || list_has(options->passes, slot));
        if (runs && changes_capture(pipeline->passes[p].pass, planner->source->capture)) return &pipeline->passes[p];
    }
    return NULL;
}

void planner_renew(struct planner *planner, const struct glint_pipeline *pipeline,
                   const struct glint_replay_options *options) {
    const bool changed = changing_pass(planner, pipeline, options), history = planner->survey.figures.has_history;
    if (changed || planner->survey.changed) planner_load(planner);
    planner->survey.figures.has_history = history;
    planner->survey.changed = changed;
}

bool planner_survey(struct planner *planner, const struct glint_pipeline *pipeline,
                    const struct glint_replay_options *options, bool whole, struct glint_error *err) {
    struct survey_state *survey = &planner->survey;
    if (survey->done && !(whole && survey->figures.partial)) return true;
    const double start = glint_now_seconds();
    survey->time = (struct glint_time){0};
    if (!read_gbuffer(planner, pipeline, err)) {
        channels_finish(&planner->source->gbuffer);
        return false;
    }
    planner->source->seconds[PHASE_READ] += glint_now_seconds() - start;
    if (!counting_pass(planner)) survey_channels(&planner->source->gbuffer, &survey->figures);
    else {
        const enum glint_pass_role figures = GLINT_ROLE_SURVEY_FIGURES;
        const struct pipeline_pass *before = changing_pass(planner, pipeline, options);
        uint32_t *found = survey_run(planner, before, NULL, &figures, 1, whole, options, &survey->time, err);
        if (!found) return false;
        read_figures(&survey->figures, found, whole);
        free(found);
    }
    survey->done = true;
    return true;
}
