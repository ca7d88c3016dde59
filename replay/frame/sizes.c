/* Sizes of images: from the capture, from tables, or from what is read instead of computed. */
#include "frame_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shared/work_list.h"

/* Width and height of an image whose contents already exist; false for one that the device will write. */
static bool existing_size(const struct frame_plan *plan, const struct graph_image *image, uint32_t size[2]) {
    const struct glint_table *table = tables_find(plan->tables, image->name);
    size[0] = size[1] = 0;
    if (image->source == SOURCE_MADE && table) size[0] = table->width, size[1] = table->height;
    else if (image->source == SOURCE_RUN) {
        const struct glint_run_image *info = plan_stored_image(plan, image, image->name);
        size[0] = info->width, size[1] = info->height;
    } else if (image->source == SOURCE_ENGINE) {
        char name[128];
        snprintf(name, sizeof name, "engine.%.48s.%.48s", image->pass->slot, image->name);
        const struct glint_part_info *part = glint_capture_find(plan->source->capture, name);
        size[0] = part->width, size[1] = part->height;
    } else return false;
    return true;
}

/* The list of active cube maps, from the table or from the run that replaces it. */
static bool read_active(struct frame_plan *plan, const struct graph_image *image, struct glint_error *err) {
    const struct glint_table *table = tables_find(plan->tables, image->name);
    uint32_t size[2];
    if (!existing_size(plan, image, size) || !size[0]) return true;
    plan->active = calloc((size_t)size[0] * size[1], sizeof *plan->active);
    if (!plan->active) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (image->source == SOURCE_RUN)
        return glint_run_read(plan->inputs, glint_run_find(plan->inputs, image->name), GLINT_U32, plan->active, err);
    if (table && table->texels.u && glint_format_is_uint(image->row->format))
        memcpy(plan->active, table->texels.u, (size_t)size[0] * sizeof *plan->active);
    else
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "image %s: expected a table of a pass or of a run",
                          image->name);
    return true;
}

static uint32_t parts_of(uint32_t length, uint32_t part) {
    return (length + part - 1) / part;
}
uint32_t tile_count(const struct frame_sizes *sizes) {
    return parts_of(sizes->full[0], TILE_WIDE) * parts_of(sizes->full[1], TILE_WIDE);
}

bool plan_find_sizes(struct frame_plan *plan, struct glint_error *err) {
    struct glint_capture *capture = plan->source->capture;
    struct frame_sizes *sizes = &plan->sizes;
    const char *order = cubemap_order_image();
    const struct glint_part_info *gbuffer = glint_capture_find(capture, GLINT_PART_GBUFFER),
                                 *sky = glint_capture_find(capture, GLINT_PART_SKY),
                                 *planar = glint_capture_find(capture, GLINT_PART_MIRROR),
                                 *table = glint_capture_find(capture, PART_COLORS),
                                 *dirt = glint_capture_find(capture, PART_DIRT),
                                 *grid = glint_capture_find(capture, PART_GRID),
                                 *froxels = glint_capture_find(capture, PART_FROXELS);
    if (!gbuffer) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part gbuffer: missing", glint_capture_path(capture));
    *sizes = (struct frame_sizes){.full = {gbuffer->width, gbuffer->height},
                                  .half = {(gbuffer->width + 1) / 2, (gbuffer->height + 1) / 2},
                                  .sky_face = sky ? sky->width : 0,
                                  .is_cpu = plan->is_cpu};
    const struct glint_part_info *levels[GLINT_MAX_LEVELS];
    double roughness[GLINT_MAX_LEVELS];
    sizes->probe_mips = (uint32_t)glint_capture_probe(capture, 0, levels, roughness);
    if (sizes->probe_mips) sizes->probe_face = levels[0]->width;
    const struct glint_part_info *maps[SHADOW_MAPS];
    for (size_t k = frame_shadow_maps(capture, maps); k-- > 0; sizes->shadow[1] += maps[k]->height)
        if (maps[k]->width > sizes->shadow[0]) sizes->shadow[0] = maps[k]->width;
    if (table) sizes->table[0] = table->width, sizes->table[1] = table->height;
    if (dirt) sizes->dirt[0] = dirt->width, sizes->dirt[1] = dirt->height;
    if (froxels)
        sizes->froxels[0] = froxels->width, sizes->froxels[1] = froxels->height,
        sizes->slices = froxels->froxels.slices;
    if (planar) sizes->planar[0] = planar->width, sizes->planar[1] = planar->height;
    sizes->grid[0] = grid ? grid->width : GRID_CELLS;
    sizes->grid[1] = grid ? grid->height : GRID_CELLS * GRID_CELLS;
    if (pipeline_traces_all_pixels(plan->pipeline)) sizes->half[0] = sizes->full[0], sizes->half[1] = sizes->full[1];
    const size_t count = plan->source->cubemap_count;
    for (size_t i = 0; i < count; i++)
        if (plan->source->cubemaps[i]->width > sizes->cube_face) sizes->cube_face = plan->source->cubemaps[i]->width;
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        const struct graph_image *image = &plan->graph.images[i];
        uint32_t size[2];
        if (!existing_size(plan, image, size)) continue;
        if (image->row->size == GLINT_SIZE_CHAIN) sizes->chain = size[0], sizes->active = size[1];
        if (image->row->size == GLINT_SIZE_ACTIVE) sizes->active = size[0];
        if (order && strcmp(image->name, order) == 0 && !read_active(plan, image, err)) return false;
    }
    for (uint32_t i = 0; plan->active && i < sizes->active; i++)
        if (plan->active[i] >= count)
            return glint_fail(err, GLINT_ERROR_FORMAT, "image %s: texel %u selects cube map %u, but %s has %zu", order,
                              i, plan->active[i], glint_capture_path(capture), count);
    return true;
}

/* The rule stands at enum glint_size_class. */
static void picture_size(const struct frame_sizes *sizes, enum glint_size_class size, uint32_t found[2]) {
    const unsigned shift = glint_size_shift(size);
    for (int i = 0; i < 2; i++) {
        found[i] = shift ? sizes->half[i] >> (shift - 1) : sizes->full[i];
        if (!found[i]) found[i] = 1;
    }
}

static uint32_t count_levels(const struct frame_sizes *sizes, enum glint_size_class size,
                             const struct image_desc *desc) {
    if (!size_has_levels(size)) return 1;
    if (size == GLINT_SIZE_PROBE_MIPS && sizes->probe_mips) return sizes->probe_mips;
    const uint32_t all = level_count(desc->width, desc->height),
                   most = glint_size_is_picture(size) ? glint_size_levels(size) : 0;
    return most && most < all ? most : all;
}

bool plan_describe(const struct frame_plan *plan, const struct graph_image *image, struct image_desc *desc,
                   struct glint_error *err) {
    const struct frame_sizes *sizes = &plan->sizes;
    const struct glint_row *row = image->row;
    const bool cube = size_is_cube(row->size);
    const uint32_t layers = cube ? 6 : row->size == GLINT_SIZE_PARABOLOIDS_MIPS ? 2 : 0;
    *desc = (struct image_desc){.format = row->format,
                                .width = 1,
                                .height = 1,
                                .layers = layers,
                                .cube = cube,
                                .levels = 1,
                                .buffer = size_is_buffer(row->size)};
    if (plan->options->float_precision) desc->format = format_widened(row->format);
    if (image->source == SOURCE_FALLBACK && !image->blank) {
        if (desc->buffer) desc->width = LIST_WIDTH; /* the header needs this width */
        return true;
    }
    uint32_t expected[2] = {0, 0}, found[2];
    switch (row->size) {
    default: /* a class of the picture */
        picture_size(sizes, row->size, expected);
        break;
    case GLINT_SIZE_CUBEMAPS:
    case GLINT_SIZE_CUBEMAPS_MIPS:
    case GLINT_SIZE_PARABOLOIDS_MIPS:
        expected[0] = expected[1] = sizes->cube_face;
        desc->layers = layers * (sizes->active ? sizes->active : 1);
        break;
    case GLINT_SIZE_COCOON:
        expected[0] = expected[1] = sizes->active ? SMALL_FACE : 0;
        desc->layers = layers * (sizes->active ? sizes->active : 1);
        break;
    case GLINT_SIZE_SKY:
    case GLINT_SIZE_SKY_MIPS:
        expected[0] = expected[1] = sizes->sky_face;
        break;
    case GLINT_SIZE_PROBE_MIPS:
        expected[0] = expected[1] = sizes->probe_face;
        break;
    case GLINT_SIZE_ACTIVE:
        expected[0] = sizes->active, expected[1] = 1;
        break;
    case GLINT_SIZE_CHAIN:
        expected[0] = sizes->chain, expected[1] = sizes->active;
        break;
    case GLINT_SIZE_VOLUME:
        if (existing_size(plan, image, found)) expected[0] = found[0], expected[1] = sizes->active;
        break;
    case GLINT_SIZE_FIGURES:
        expected[0] = FIGURES, expected[1] = 1;
        break;
    case GLINT_SIZE_PLANAR:
        expected[0] = sizes->planar[0], expected[1] = sizes->planar[1];
        break;
    case GLINT_SIZE_SHADOW:
        expected[0] = sizes->shadow[0], expected[1] = sizes->shadow[1];
        break;
    case GLINT_SIZE_TABLE:
        expected[0] = sizes->table[0], expected[1] = sizes->table[1];
        break;
    case GLINT_SIZE_DIRT:
        expected[0] = sizes->dirt[0], expected[1] = sizes->dirt[1];
        break;
    case GLINT_SIZE_PART: {
        const struct glint_part_info *part = row->role ? glint_capture_find(plan->source->capture, row->role) : NULL;
        if (part) expected[0] = part->width, expected[1] = part->height;
        break;
    }
    case GLINT_SIZE_GRID:
        expected[0] = sizes->grid[0], expected[1] = sizes->grid[1];
        break;
    case GLINT_SIZE_FROXELS:
        expected[0] = sizes->froxels[0], expected[1] = sizes->froxels[1];
        break;
    case GLINT_SIZE_FROXEL_SLICE:
        expected[0] = sizes->froxels[0], expected[1] = sizes->froxels[1] / (sizes->slices ? sizes->slices : 1);
        break;
    case GLINT_SIZE_LIST:
        expected[0] = LIST_WIDTH;
        expected[1] = parts_of(
            LIST_WORDS(parts_of(sizes->full[0], REGION_WIDE) * parts_of(sizes->full[1], REGION_WIDE)), LIST_WIDTH);
        break;
    }
    if (existing_size(plan, image, found) && !(layers && !expected[0]) &&
        (found[0] != expected[0] || found[1] != expected[1] * image_layers(desc)))
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: image %s: expected %u x %u, found %u x %u",
                          image->source == SOURCE_RUN ? plan->options->inputs
                                                      : glint_capture_path(plan->source->capture),
                          image->name, expected[0], expected[1] * image_layers(desc), found[0], found[1]);
    if (!expected[0] || !expected[1]) desc->layers = layers; /* no active cube map: a placeholder */
    else desc->width = expected[0], desc->height = expected[1];
    desc->levels = count_levels(sizes, row->size, desc);
    if (desc->levels > LEVELS_MAX)
        return glint_fail(err, GLINT_ERROR_LIMIT, "image %s: %u levels, expected at most %d", image->name, desc->levels,
                          LEVELS_MAX);
    return true;
}
