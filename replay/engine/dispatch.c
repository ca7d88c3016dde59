/* What a pass's rows dispatch: a list of dispatches, each with its level, its phase and its descriptors. */
#include "run.h"

#include <stdlib.h>
#include <string.h>

#include "shared/tile_list.h"
#include "tile_range.h"

struct pooled *run_image(const struct run *run, const char *name) {
    const struct graph_image *image = graph_find(run->graph, name);
    return image ? run->images[image - run->graph->images] : NULL;
}

struct pooled *run_bound(const struct run *run, const struct glint_row *binding) {
    return run->images[graph_bound(run->graph, binding) - run->graph->images];
}

static bool starts_dispatch(const struct glint_row *row) {
    return row_is_dispatch(row) || row->kind == GLINT_ROW_DISPATCH_LIST;
}

/* The layers of a level that a dispatch works on; NULL: all. */
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
    const uint32_t *half = run->sizes->half;
    struct extent extent = image_extent(&image->image.desc, level);
    struct workgroup group = pass_workgroup(step->pass->pass);
    const uint32_t block = block_width(run->sizes, step->pass->pass);
    group.width *= block, group.height *= block;
    const enum glint_size_class size = graph_find(run->graph, image->image.name)->row->size;
    if (size == GLINT_SIZE_TILES) {
        extent = (struct extent){run->sizes->full[0], run->sizes->full[1]};
        group = (struct workgroup){REGION_WIDE * STRIP_WIDE, REGION_HIGH * TILE_HIGH};
    } else if (image->image.desc.buffer) {
        extent = (struct extent){half[0], half[1]};
        group = (struct workgroup){LIST_BLOCK, LIST_BLOCK};
    }
    struct dispatch *dispatch = &step->dispatches[step->dispatch_count++];
    *dispatch = (struct dispatch){.phase = phase,
                                  .level = level,
                                  .tiles = ALL_TILES,
                                  .groups = {(extent.width + group.width - 1) / group.width,
                                             (extent.height + group.height - 1) / group.height,
                                             image_layers(&image->image.desc)}};
    const uint64_t texels = dispatch_texels(run->sizes, &image->image.desc, size, level);
    dispatch->layers = needed_layers(run, step, row, level, &dispatch->layer_runs);
    if (!dispatch->layers) step->texels += texels;
    for (uint32_t i = 0; i < dispatch->layer_runs; i++)
        step->texels += texels / dispatch->groups[2] * dispatch->layers[i].count;
    if (size != GLINT_SIZE_TILES) return;
    dispatch->tile_wide = TILE_WIDE;
    if (run->sizes->tile_wide == TILE_WIDE) return;
    step->dispatches[step->dispatch_count] = *dispatch; /* the list of strips, from that of tiles */
    step->dispatches[step->dispatch_count++].tile_wide = run->sizes->tile_wide;
}

static void add_level_dispatches(const struct run *run, struct step *step, uint32_t phase, const struct glint_row *row,
                                 const struct pooled *image) {
    uint32_t fine, coarse;
    if (!dispatch_levels(step->pass, row, &image->image.desc, &fine, &coarse)) return;
    for (uint32_t i = 0; i <= coarse - fine; i++)
        add_dispatch(run, step, phase, row, image, row->order == GLINT_ORDER_up ? coarse - i : fine + i);
}

/* The images of the rows DISPATCH_LIST that follow row `r`; 0 when there are none, or one of them was not made. */
static size_t lists_after(const struct run *run, const struct glint_pass *pass, size_t r, struct pooled **lists) {
    size_t count = 0;
    while (++r < pass->row_count) {
        const struct glint_row *row = &pass->rows[r];
        if (row->kind != GLINT_ROW_DISPATCH_LIST && starts_dispatch(row)) break;
        if (row->kind != GLINT_ROW_DISPATCH_LIST) continue;
        if (graph_find(run->graph, row->name)->source == SOURCE_FALLBACK) return 0;
        lists[count++] = run_image(run, row->name);
    }
    return count;
}

static struct pooled *tile_list(const struct run *run, const struct glint_pass *pass) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].optional && pass->rows[r].size == GLINT_SIZE_TILES &&
            graph_find(run->graph, pass->rows[r].name)->source == SOURCE_MADE)
            return run_image(run, pass->rows[r].name);
    return NULL;
}

/* The row DISPATCH_TILES that follows row `r`, when the list is there and the shader, maybe a user's, knows of tiles. */
static const struct glint_row *tiles_after(const struct run *run, const struct step *step, size_t r) {
    const struct glint_pass *pass = step->pass->pass;
    if (!tile_list(run, pass) || !step->spirv.tiles) return NULL;
    while (++r < pass->row_count && pass->rows[r].kind != GLINT_ROW_DISPATCH &&
           pass->rows[r].kind != GLINT_ROW_DISPATCH_LEVELS)
        if (pass->rows[r].kind == GLINT_ROW_DISPATCH_TILES) return &pass->rows[r];
    return NULL;
}

/* Over the tiles of a range, and over the rest; where the list says with how many workgroups: shared/tile_list.h. */
static bool add_tile_dispatches(const struct run *run, struct step *step, uint32_t phase, const struct pooled *image,
                                const struct glint_row *row, struct glint_error *err) {
    const struct workgroup group = pass_workgroup(step->pass->pass);
    const struct extent size = tile_extent(run->sizes, &image->image.desc, STRIP_WIDE);
    const uint32_t strips = group.width * group.height / (size.width * size.height),
                   wide = tile_wide(run->sizes, step->pass->pass);
    uint32_t range = 0;
    while (range < RANGES && strcmp(range_names[range], row->name) != 0) range += 2;
    if (range >= RANGES || (strips != 2 && strips != 4 && strips != 8))
        return glint_fail(
            err, GLINT_ERROR_USAGE,
            "%s/%s: DISPATCH_TILES %s: expected a range of tiles, 2, 4 or 8 times %u x %u texels in a workgroup",
            step->pass->pass->slot, step->pass->pass->variant, row->name, size.width, size.height);
    for (uint32_t rest = 0; rest < 2; rest++)
        step->dispatches[step->dispatch_count++] = (struct dispatch){
            .phase = phase,
            .list = tile_list(run, step->pass->pass),
            .from = 4 * (VkDeviceSize)(tile_begin(run->sizes, wide) + 12 * (range + rest) + 4 * (strips / 4)),
            .tiles = range + rest,
            .over = &image->image.desc,
            .tile_wide = wide,
            .rest = rest};
    return true;
}

bool step_plan(const struct run *run, struct step *step, struct glint_error *err) {
    const struct glint_pass *pass = step->pass->pass;
    step->dispatches = calloc(pass->row_count * LEVELS_MAX, sizeof *step->dispatches);
    if (!step->dispatches) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    struct pooled *lists[PASS_IMAGES_MAX];
    uint32_t phase = 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!starts_dispatch(row)) continue;
        const struct pooled *image = run_image(run, row->name);
        if (!image)
            return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s dispatches over %s, which it neither reads nor writes",
                              pass->slot, pass->variant, row->name);
        const size_t count = row->kind == GLINT_ROW_DISPATCH ? lists_after(run, pass, r, lists) : 0;
        for (size_t i = 0; i < count; i++)
            step->dispatches[step->dispatch_count++] =
                (struct dispatch){.phase = phase + 1 + (uint32_t)i, .list = lists[i], .tiles = ALL_TILES};
        const struct glint_row *tiles =
            row->kind == GLINT_ROW_DISPATCH && count == 0 ? tiles_after(run, step, r) : NULL;
        if (tiles && !add_tile_dispatches(run, step, phase, image, tiles, err)) return false;
        if (row->kind == GLINT_ROW_DISPATCH && count == 0 && !tiles) add_dispatch(run, step, phase, row, image, 0);
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS) add_level_dispatches(run, step, phase, row, image);
        phase++;
    }
    if (phase > 0) return true;
    return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s declares no image to dispatch over", pass->slot, pass->variant);
}
