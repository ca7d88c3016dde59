/* The result of an effect, the capture's truth of it, the class of each pixel. */
#include "glint/study.h"
#include "question.h"
#include "values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

uint32_t glint_effect_channels(const struct glint_effect *effect, const char **names) {
    static const char *const letters[] = {"", "R", "R G", "R G B", "R G B A"};
    struct study_channel_list list;
    study_split_channels(effect->channels, &list);
    if (names) *names = letters[list.count];
    return list.count;
}

/* ---- Pixels ---- */

struct glint_classes glint_study_classes_of(const struct glint_effect *effect, const uint8_t *labels) {
    struct glint_classes classes = {.title = effect->class_title, .labels = (uint8_t *)(uintptr_t)labels};
    classes.count = (uint32_t)glint_effect_class_count(effect);
    for (uint32_t k = 0; k < classes.count; k++) classes.names[k] = effect->classes[k].name;
    return classes;
}

/* What pixels are classed by; NULL if the capture does not have it. */
static bool read_measure(struct glint_capture *capture, const struct glint_effect *effect, size_t pixels,
                         float **measure, struct glint_error *err) {
    const struct glint_part_info *part = effect->class_part ? glint_capture_find(capture, effect->class_part) : NULL;
    *measure = NULL;
    if (!part || !glint_part_can_read(part, effect->class_channel)) return true;
    if ((size_t)part->width * part->height != pixels)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected the size of the G-buffer",
                          glint_capture_path(capture), part->name);
    return (*measure = study_channels(capture, part->name, &effect->class_channel, 1, err)) != NULL;
}

static bool is_judged(const struct glint_effect *effect, float depth, float metalness, float specular) {
    return effect->judged == GLINT_JUDGED_ALL ||
           (depth < INFINITY && (effect->judged == GLINT_JUDGED_SURFACES || metalness > 0 || specular > 0));
}

uint8_t *glint_study_labels(struct glint_capture *capture, const struct glint_effect *effect, struct glint_error *err) {
    static const char *const channels[] = {"depth.Z", "material.metalness", "material.specular"};
    float *values = study_channels(capture, GLINT_PART_GBUFFER, channels, 3, err), *measure = NULL;
    if (!values) return NULL;
    const struct glint_part_info *part = glint_capture_find(capture, GLINT_PART_GBUFFER);
    const size_t pixels = (size_t)part->width * part->height;
    uint8_t *labels = read_measure(capture, effect, pixels, &measure, err) ? calloc(pixels, 1) : NULL;
    if (!labels && !(err && err->code)) glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    for (size_t i = 0; labels && i < pixels; i++)
        if (is_judged(effect, values[3 * i], values[3 * i + 1], values[3 * i + 2]))
            labels[i] = (uint8_t)(measure ? glint_effect_class_of(effect, (double)measure[i]) : GLINT_CLASS_UNKNOWN);
    free(measure);
    free(values);
    return labels;
}

/* ---- Results ---- */

const struct glint_row *glint_study_made(const struct glint_pipeline *pipeline, const struct glint_effect *effect) {
    for (size_t k = 0; k < GLINT_EFFECT_RESULTS && effect->results[k]; k++)
        for (size_t p = 0; p < glint_pipeline_pass_count(pipeline); p++) {
            const struct glint_row *row = glint_pass_output(glint_pipeline_pass(pipeline, p), effect->results[k]);
            if (row && row->size == GLINT_SIZE_FULL) return row;
        }
    return NULL;
}

const struct glint_image *glint_study_result_image(struct glint_replay *replay, const struct glint_effect *effect) {
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t k = 0; k < GLINT_EFFECT_RESULTS && effect->results[k]; k++)
        for (size_t i = 0; i < count; i++) {
            const struct glint_row *row =
                results[i].shown ? glint_pass_output(results[i].pass, effect->results[k]) : NULL;
            const struct glint_image *image =
                row && row->size == GLINT_SIZE_FULL ? glint_replay_find_image(replay, row->name) : NULL;
            if (image) return image;
        }
    return NULL;
}

bool glint_study_result(struct glint_replay *replay, const struct glint_effect *effect, struct glint_pixels *pixels,
                        struct glint_error *err) {
    const struct glint_image *image = glint_study_result_image(replay, effect);
    *pixels = (struct glint_pixels){0};
    if (!image)
        return glint_fail(err, GLINT_ERROR_USAGE, "the run has no %s at full resolution to compare", effect->noun);
    *pixels = (struct glint_pixels){image->width, image->height, image->components, NULL};
    return (pixels->values = study_values(replay, image, GLINT_F32, err)) != NULL;
}

const struct glint_run_image *glint_study_run_result_image(const struct glint_run *run,
                                                           const struct glint_effect *effect) {
    for (size_t k = 0; k < GLINT_EFFECT_RESULTS && effect->results[k]; k++) {
        const struct glint_run_image *image = glint_run_find(run, effect->results[k]);
        if (image && !image->integer && !image->cube) return image;
    }
    return NULL;
}

bool glint_study_run_result(struct glint_run *run, const struct glint_effect *effect, struct glint_pixels *pixels,
                            struct glint_error *err) {
    const struct glint_run_image *image = glint_study_run_result_image(run, effect);
    *pixels = (struct glint_pixels){0};
    if (!image) return glint_fail(err, GLINT_ERROR_USAGE, "the run has no %s to compare with", effect->noun);
    *pixels = (struct glint_pixels){image->width, image->height, image->components, NULL};
    return (pixels->values = study_run_values(run, image, err)) != NULL;
}

/* ---- Truth ---- */

/* The choice of the parameter with a role; the default where there is no pipeline. NULL where the pipeline has no such parameter. */
static const char *choice_of(enum glint_pass_role role, const struct glint_pipeline *pipeline, size_t *place) {
    const char *name;
    char choice[64];
    const struct glint_pass *any = glint_pass_with_role(role, &name);
    const struct glint_row *row = any ? glint_pass_parameter(any, name) : NULL;
    if (!row || !row->choices || (pipeline && !study_parameter_text(pipeline, any->slot, name, choice))) return NULL;
    *place = (size_t)row->initial;
    for (size_t i = 0; pipeline && row->choices[i]; i++)
        if (!strcmp(row->choices[i], choice)) *place = i;
    return row->choices[*place];
}

void glint_study_truth_part(const struct glint_effect *effect, const struct glint_pipeline *pipeline, char part[96]) {
    size_t place;
    const char *choice = effect->truth_has_choices ? choice_of(effect->truth_by, pipeline, &place) : NULL;
    if (effect->truth_has_choices && !choice) choice = choice_of(effect->truth_by, NULL, &place);
    snprintf(part, 96, choice ? "%s.%s" : "%s", effect->truth ? effect->truth : "", choice);
}

static void truth_channels(const struct glint_effect *effect, const struct glint_pipeline *pipeline,
                           struct study_channel_list *channels) {
    size_t place;
    study_split_channels(effect->channel_choices ? effect->channel_choices : effect->channels, channels);
    if (!effect->channel_choices) return;
    if (!choice_of(effect->channel_by, pipeline, &place) || place >= channels->count) place = channels->count - 1;
    channels->names[0] = channels->names[place];
    channels->count = 1;
}

/* The relative standard error of each pixel: 0 if the part declares none, +inf where nothing is known. */
static bool truth_errors(struct glint_capture *capture, const struct glint_part_info *part, float **error,
                         struct glint_error *err) {
    const bool weighted = glint_part_has_channel(part, "weight");
    const char *const channels[] = {glint_part_has_channel(part, "error") ? "error" : NULL, weighted ? "weight" : NULL};
    const size_t pixels = (size_t)part->width * part->height;
    float *read = channels[0] || channels[1] ? study_channels(capture, part->name, channels, 2, err)
                                             : calloc(2 * pixels, sizeof *read);
    if (!read)
        return channels[0] || channels[1] ? false
                                          : glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    for (size_t i = 0; i < pixels; i++) read[i] = !weighted || read[2 * i + 1] > 0 ? read[2 * i] : INFINITY;
    *error = read;
    return true;
}

bool glint_study_truth(struct glint_capture *capture, const struct glint_effect *effect,
                       const struct glint_pipeline *pipeline, struct glint_pixels *pixels, float **error,
                       struct glint_error *err) {
    char name[96];
    struct study_channel_list channels;
    *pixels = (struct glint_pixels){0};
    *error = NULL;
    if (effect->no_truth)
        return glint_fail(err, GLINT_ERROR_FORMAT, "the effect %s has no truth: %s", effect->name, effect->no_truth);
    glint_study_truth_part(effect, pipeline, name);
    const struct glint_part_info *part = glint_capture_find(capture, name);
    if (!part) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: missing", glint_capture_path(capture), name);
    truth_channels(effect, pipeline, &channels);
    *pixels = (struct glint_pixels){part->width, part->height, channels.count,
                                    study_channels(capture, name, channels.names, channels.count, err)};
    if (pixels->values && truth_errors(capture, part, error, err)) return true;
    free(pixels->values);
    *pixels = (struct glint_pixels){0};
    return false;
}
