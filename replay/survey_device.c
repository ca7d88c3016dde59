/* The survey on the device: one pass over the capture's images, which stay there for the run that it is for. */
#include "state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "timing.h"

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
    survey->transparent_roughness = as_float(f[at_transparent_roughest]);
    survey->whole = true;
    survey->brief = !whole;
}

const struct glint_pass *survey_pass(void) {
    return glint_pass_find("survey", "gbuffer");
}

/* The pixels of images, one after the other. */
static uint32_t *read_images(struct glint_replay *replay, const char *const *names, struct glint_error *err) {
    uint32_t *values = NULL;
    size_t count = 0;
    for (; *names; names++) {
        const struct glint_image *image = glint_replay_find_image(replay, *names);
        const size_t more = (size_t)image->width * image->height;
        uint32_t *larger = realloc(values, (count + more) * sizeof *values);
        if (larger) values = larger;
        else glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", *names);
        if (!larger || !glint_replay_read_image(replay, image, GLINT_U32, values + count, err)) {
            free(values);
            return NULL;
        }
        count += more;
    }
    return values;
}

uint32_t *survey_run(struct glint_replay *replay, struct pipeline_pass *passes, size_t count,
                     const char *const *outputs, const struct glint_replay_options *wanted, struct glint_time *time,
                     struct glint_error *err) {
    static double no_values[64];
    char name[] = "survey";
    const char *force[8] = {NULL};
    for (size_t i = 0; i < count && i + 1 < sizeof force / sizeof *force; i++) {
        force[i] = passes[i].pass->slot;
        if (!passes[i].values) passes[i].values = no_values;
    }
    const struct glint_pipeline pipeline = {.name = name, .passes = passes, .count = count};
    const struct glint_replay_options options = {.outputs = outputs,
                                                 .force = force,
                                                 .repeat = wanted->repeat,
                                                 .warmup = wanted->warmup,
                                                 .no_cache = true,
                                                 .lineage = UINT32_MAX};
    struct run run = {.replay = replay, .pipeline = &pipeline, .options = &options, .survey = true};
    replay->surveying = true;
    uint32_t *values = run_work(&run, err) ? read_images(replay, outputs, err) : NULL;
    replay->surveying = false;
    for (size_t p = 0; values && p < run.graph.pass_count; p++)
        if (run.steps[p].execute) *time = time_statistics(run.steps[p].ns, run.steps[p].timed);
    run_release(&run);
    return values;
}

bool survey_on_device(struct glint_replay *replay, const struct glint_replay_options *wanted, bool whole,
                      struct glint_error *err) {
    static const char *const outputs[] = {"survey_figures", NULL};
    double values[64] = {0};
    struct pipeline_pass pass = {.pass = survey_pass(), .values = values};
    for (size_t r = 0; r < pass.pass->row_count; r++) values[r] = whole; /* its one parameter */
    uint32_t *figures = survey_run(replay, &pass, 1, outputs, wanted, &replay->survey_time, err);
    if (figures) read_figures(&replay->survey, figures, whole);
    free(figures);
    return figures != NULL;
}
