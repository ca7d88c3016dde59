/* Reads images of runs and channels of captures into memory. */
#include "values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "no_memory.h"

const struct glint_image *study_image(const struct glint_replay *replay, enum glint_pass_role role) {
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    const struct glint_image *last = NULL;
    for (size_t i = 0; i < count; i++) {
        const struct glint_row *row = glint_pass_role(results[i].pass, role);
        const struct glint_image *image = row ? glint_replay_find_image(replay, row->image) : NULL;
        if (image) last = image;
    }
    return last;
}

const char *study_tracer_label(enum glint_pass_role end) {
    const char *image;
    return glint_pass_row(glint_pass_with_role(end, &image), GLINT_ROW_TRACER, NULL)->name;
}

void *study_values(struct glint_replay *replay, const struct glint_image *image, enum glint_type type,
                   struct glint_error *err) {
    void *values = malloc((size_t)image->width * image->height * image->components * sizeof(float));
    if (!values) glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", image->name);
    if (values && glint_replay_read_image(replay, image, type, values, err)) return values;
    free(values);
    return NULL;
}

float *study_channels(struct glint_capture *capture, const char *name, const char *const *channels, size_t count,
                      struct glint_error *err) {
    const struct glint_part_info *part = glint_capture_find(capture, name);
    float *values = part ? malloc((size_t)part->width * part->height * count * sizeof *values) : NULL;
    if (!part) glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: missing", glint_capture_path(capture), name);
    else if (!values) glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", name);
    if (values && glint_capture_read(capture, part, channels, count, GLINT_F32, values, 0, err)) return values;
    free(values);
    return NULL;
}

float *study_run_values(struct glint_run *run, const struct glint_run_image *image, struct glint_error *err) {
    float *values = malloc((size_t)image->width * image->height * image->components * sizeof *values);
    if (!values) no_memory(err, image->name);
    if (values && glint_run_read_linear(run, image, values, err)) return values;
    free(values);
    return NULL;
}

void study_split_channels(const char *channels, struct study_channel_list *list) {
    char *rest = NULL;
    snprintf(list->text, sizeof list->text, "%s", channels);
    list->count = 0;
    for (char *word = strtok_r(list->text, " ", &rest); word && list->count < 4; word = strtok_r(NULL, " ", &rest))
        list->names[list->count++] = word;
}

const struct glint_image *study_radiance(struct glint_replay *replay, const struct glint_pass *pass) {
    const struct glint_image *last = NULL;
    for (size_t i = 0; i < pass->row_count; i++) {
        const struct glint_row *row = &pass->rows[i];
        if (row->kind != GLINT_ROW_WRITE || row->size != GLINT_SIZE_FULL || strcmp(row->unit, "radiance")) continue;
        const struct glint_image *image = glint_replay_find_image(replay, row->name);
        if (image) last = image;
    }
    return last;
}
