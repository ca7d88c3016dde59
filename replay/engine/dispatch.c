/* Turns the rows of a pass into dispatches. */
#include "run.h"

#include <stdlib.h>

#include "shared/work_list.h"

/* The layers that a dispatch over a MIP level runs over; NULL: all. */
static struct face_run *needed_layers(const struct run *run, const struct step *step, const struct glint_row *row,
                                      uint32_t level, uint32_t *count) {
    uint8_t faces[GLINT_SURVEY_CUBEMAPS];
    if (!plan_dispatched_faces(run->plan, step->pass, row, level, faces)) return NULL;
    struct face_run *layers = calloc(FACE_RUNS_MAX, sizeof *layers);
    if (layers) *count = face_runs(faces, run->sizes->active, layers);
    return layers;
}

static void add_dispatch(const struct run *run, struct step *step, uint32_t phase, const struct glint_row *row,
                         const struct pooled *image, uint32_t level) {
    struct extent extent = image_extent(&image->image.desc, level);
    struct workgroup group = pass_workgroup(step->pass->pass, run->sizes->is_cpu);
    const uint32_t block = pass_block(step->pass->pass, run->sizes->is_cpu);
    group.width *= block, group.height *= block;
    if (image->image.desc.buffer) {
        extent = (struct extent){run->sizes->full[0], run->sizes->full[1]};
        group = (struct workgroup){REGION_WIDE, REGION_WIDE};
    }
    struct dispatch *dispatch = &step->dispatches[step->dispatch_count++];
    *dispatch = (struct dispatch){.phase = phase,
                                  .level = level,
                                  .range = ALL_TILES,
                                  .groups = {(extent.width + group.width - 1) / group.width,
                                             (extent.height + group.height - 1) / group.height,
                                             image_layers(&image->image.desc)}};
    const uint64_t texels = dispatch_texels(run->sizes, &image->image.desc, level);
    dispatch->layers = needed_layers(run, step, row, level, &dispatch->layer_runs);
    if (!dispatch->layers) step->texels += texels;
    for (uint32_t i = 0; i < dispatch->layer_runs; i++)
        step->texels += texels / dispatch->groups[2] * dispatch->layers[i].count;
}

static void add_level_dispatches(const struct run *run, struct step *step, uint32_t phase, const struct glint_row *row,
                                 const struct pooled *image) {
    uint32_t fine, coarse;
    if (!dispatch_levels(run->sizes, step->pass, row, &image->image.desc, &fine, &coarse)) return;
    for (uint32_t i = 0; i <= coarse - fine; i += row_levels(row, run->sizes->is_cpu))
        add_dispatch(run, step, phase, row, image, row->order == GLINT_ORDER_up ? coarse - i : fine + i);
}

bool step_plan(const struct run *run, struct step *step, struct glint_error *err) {
    const struct glint_pass *pass = step->pass->pass;
    step->dispatches = calloc(pass->row_count * LEVELS_MAX, sizeof *step->dispatches);
    if (!step->dispatches) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    uint32_t phase = 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!row_is_dispatch(row)) continue;
        const struct pooled *image = run_image(run, row->name);
        if (!image)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s dispatches over %s, which it neither reads nor writes",
                              pass->slot, pass->variant, row->name);
        const struct glint_row *list = row->kind == GLINT_ROW_DISPATCH ? step_list(run, step, r) : NULL;
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS) add_level_dispatches(run, step, phase, row, image);
        else if (!list) add_dispatch(run, step, phase, row, image, 0);
        else if (!step_add_list(run, step, phase, &image->image.desc, list, err)) return false;
        phase++;
    }
    if (phase > 0) return true;
    return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s declares no image to dispatch over", pass->slot, pass->variant);
}
