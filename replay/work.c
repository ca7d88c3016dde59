/* How much a pass works on: texels that its dispatches go over, as run.json and plans say it. */
#include "readback.h"

#include <stdlib.h>
#include <string.h>

#include "shared/tile_list.h"

static bool is_dispatch(const struct glint_row *row) {
    return row->kind == GLINT_ROW_DISPATCH || row->kind == GLINT_ROW_DISPATCH_LEVELS;
}

/* Of all dispatches when nothing is left out. */
static uint64_t texels_of(const struct run *run, const struct graph_pass *entry, struct glint_error *err) {
    const struct glint_pass *pass = entry->pass;
    uint64_t texels = 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!is_dispatch(row)) continue;
        struct graph_image image = {.name = row->name, .source = SOURCE_MADE};
        struct image_desc desc;
        uint32_t first = 0, last = 0;
        if (!(image.row = graph_row(&run->graph, row->name, &image.pass)) ||
            !run_describe_image(run, &image, &desc, err))
            return 0;
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS && !dispatch_levels(entry, row, &desc, &first, &last)) continue;
        for (uint32_t level = first; level <= last; level++)
            texels += dispatch_texels(run, &desc, image.row->size, level);
    }
    return texels;
}

uint64_t dispatch_texels(const struct run *run, const struct image_desc *desc, enum glint_size_class size,
                         uint32_t level) {
    const VkExtent3D extent = image_extent(desc, level);
    if (size == GLINT_SIZE_TILES) return tile_count(&run->sizes, TILE_WIDE);
    if (desc->buffer) return (uint64_t)run->sizes.half[0] * run->sizes.half[1];
    return (uint64_t)extent.width * extent.height * image_layers(desc);
}

uint64_t pass_rays(const struct graph_pass *pass, const struct glint_pipeline *pipeline) {
    return pass->rank == RANK_RAY ? glint_pipeline_rays(pipeline) : 1;
}

static uint64_t faces_of_size(const struct run *run, enum glint_size_class size) {
    return size_is_array(size) ? 6 * (uint64_t)run->sizes.active : run->sizes.sky_face ? 6 : 0;
}

/* The faces of an image that a pass makes: those of the dispatches over it, or of all where it goes with another image. The
   coarsest level takes most of them. */
static uint64_t faces_made(const struct run *run, const struct graph_pass *entry, const struct glint_row *made) {
    const struct glint_pass *pass = entry->pass;
    uint8_t faces[GLINT_SURVEY_CUBEMAPS] = {0};
    bool own = false;
    for (size_t r = 0; r < pass->row_count; r++)
        own |= is_dispatch(&pass->rows[r]) && strcmp(pass->rows[r].name, made->name) == 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!is_dispatch(row) || (own && strcmp(row->name, made->name) != 0)) continue;
        const struct graph_image image = {
            .name = row->name, .row = pass_output(pass, row->name), .source = SOURCE_MADE};
        struct image_desc desc;
        uint8_t more[GLINT_SURVEY_CUBEMAPS];
        uint32_t first, last = 0;
        if (!image.row || !run_describe_image(run, &image, &desc, NULL)) return faces_of_size(run, made->size);
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS && !dispatch_levels(entry, row, &desc, &first, &last)) continue;
        if (!run_dispatches_faces(run, pass, row, last, more)) return faces_of_size(run, made->size);
        for (uint32_t i = 0; i < run->sizes.active && i < GLINT_SURVEY_CUBEMAPS; i++) faces[i] |= more[i];
    }
    return count_faces(faces, run->sizes.active);
}

void run_count_faces(const struct run *run, struct glint_cube_faces *faces) {
    uint8_t some[GLINT_SURVEY_CUBEMAPS];
    faces->uploaded = faces->filtered = 0;
    for (size_t i = 0; i < run->graph.image_count; i++) {
        const struct graph_image *image = &run->graph.images[i];
        if (image->source == SOURCE_CAPTURE && size_is_cube(image->row->size))
            faces->uploaded += run_captures_faces(run, i, some) ? count_faces(some, run->sizes.active)
                                                                : faces_of_size(run, image->row->size);
    }
    for (size_t p = 0; p < run->graph.pass_count; p++) {
        const struct graph_pass *pass = &run->graph.passes[p];
        for (size_t r = 0; pass->runs && r < pass->pass->row_count; r++)
            if (pass->pass->rows[r].kind == GLINT_ROW_WRITE && size_is_cube(pass->pass->rows[r].size) &&
                graph_find(&run->graph, pass->pass->rows[r].name)->source == SOURCE_MADE)
                faces->filtered += faces_made(run, pass, &pass->pass->rows[r]);
    }
}

/* Sizes of what a graph will work on, without a device. */
static bool size_up(struct run *run) {
    double seconds[256];
    struct glint_error ignored = {0};
    return run->graph.pass_count <= sizeof seconds / sizeof *seconds &&
           tables_init(&run->tables, &run->graph, run->replay->capture, seconds, &ignored) && run_sizes(run, &ignored);
}

void replay_count_faces(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                        const struct glint_replay_options *options, struct glint_run *inputs,
                        const struct graph *graph) {
    struct run run = {.replay = replay, .pipeline = pipeline, .options = options, .inputs = inputs, .graph = *graph};
    if (size_up(&run)) run_count_faces(&run, &replay->faces);
    tables_finish(&run.tables);
    free(run.active);
}

void replay_whole_work(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                       const struct glint_replay_options *options, struct glint_run *inputs, struct whole_work *work) {
    struct glint_replay_options all = *options;
    struct glint_error ignored = {0};
    struct run run = {.replay = replay, .pipeline = pipeline, .options = &all, .inputs = inputs};
    struct glint_cube_faces faces = {0};
    all.all = true;
    all.outputs = NULL;
    const bool ok = replay_graph(replay, pipeline, &all, inputs, &run.graph, &ignored) && size_up(&run);
    for (size_t p = 0; ok && p < run.graph.pass_count; p++)
        work[p] = (struct whole_work){texels_of(&run, &run.graph.passes[p], &ignored) *
                                          pass_rays(&run.graph.passes[p], pipeline),
                                      run.graph.passes[p].cached_work};
    if (ok) run_count_faces(&run, &faces);
    replay->faces = (struct glint_cube_faces){.uploaded_of = faces.uploaded, .filtered_of = faces.filtered};
    tables_finish(&run.tables);
    graph_finish(&run.graph);
    free(run.active);
}

const struct glint_cube_faces *glint_replay_cube_faces(const struct glint_replay *replay) {
    return &replay->faces;
}

/* Tiles at the picture's border are cut off there. */
static uint64_t count_tiles(const struct run *run, const struct dispatch *dispatch, const uint32_t *words) {
    const uint32_t *list = words + tile_begin(&run->sizes, dispatch->tile_wide);
    const uint32_t total = tile_count(&run->sizes, dispatch->tile_wide),
                   *range = list + TILE_RANGES + 2 * dispatch->tiles;
    const uint32_t width = dispatch->over->desc.width, height = dispatch->over->desc.height;
    const VkExtent2D size = tile_extent(run, dispatch->over, dispatch->tile_wide);
    uint64_t texels = 0;
    for (uint32_t i = 0; i < range[1]; i++) {
        const uint32_t tile = list[TILE_ITEMS + (range[0] + i) % total];
        const uint32_t left = width - size.width * (tile & 0xFFFF), below = height - size.height * (tile >> 16);
        texels += (uint64_t)(left < size.width ? left : size.width) * (below < size.height ? below : size.height);
    }
    return texels;
}

static bool count_tiles_of(struct run *run, struct image *list, struct host_buffer *buffer, struct glint_error *err) {
    VkDeviceSize offset;
    if (!readback_images(run->replay, &(struct image_part){list, &list->levels[0].info}, 1, buffer, &offset, err))
        return false;
    for (size_t p = 0; p < run->graph.pass_count; p++)
        for (size_t d = 0; d < run->steps[p].dispatch_count; d++)
            if (run->steps[p].dispatches[d].list == list && !run->steps[p].dispatches[d].rest)
                run->steps[p].texels += count_tiles(run, &run->steps[p].dispatches[d], buffer->map);
    return true;
}

bool run_count_tiles(struct run *run, struct glint_error *err) {
    struct host_buffer buffer = {0};
    bool ok = true;
    for (size_t i = 0; ok && i < run->graph.image_count; i++)
        if (run->graph.images[i].row->size == GLINT_SIZE_TILES && run->graph.images[i].source == SOURCE_MADE &&
            run->images[i]->key == run->keys[i])
            ok = count_tiles_of(run, run->images[i], &buffer, err);
    host_buffer_finish(&buffer, run->replay->device);
    return ok;
}

/* Of a list: its items without what fills it up. */
static uint64_t count_items(const uint32_t *words, uint32_t width, uint64_t count) {
    uint64_t items = 0;
    for (uint64_t i = 0; i < words[3] && width + i < count; i++) items += words[width + i] != UINT32_MAX;
    return items;
}

static uint64_t count_rays(const uint8_t *reasons, uint64_t count) {
    uint64_t rays = 0;
    for (uint64_t i = 0; i < count; i++) rays += reasons[i] != 0;
    return rays;
}

/* What an image of the last run counts; false when it is not there any more. */
static bool count_image(struct glint_replay *replay, const char *name, uint64_t *found, struct glint_error *err) {
    struct host_buffer buffer = {0};
    VkDeviceSize offset;
    struct image *image = replay->images;
    while (image && !(image->used && strcmp(image->name, name) == 0)) image = image->next;
    if (!image ||
        !readback_images(replay, &(struct image_part){image, &image->levels[0].info}, 1, &buffer, &offset, err))
        return false;
    const uint64_t texels = (uint64_t)image->desc.width * image->desc.height;
    *found = image->desc.buffer ? count_items(buffer.map, image->desc.width, texels) : count_rays(buffer.map, texels);
    host_buffer_finish(&buffer, replay->device);
    return true;
}

static const char *end_reasons_of(const struct glint_pass *pass) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_DIAGNOSTIC && strcmp(pass->rows[r].unit, "end reason") == 0)
            return pass->rows[r].name;
    return NULL;
}

bool replay_count_work(struct glint_replay *replay, json_t *root, struct glint_error *err) {
    const bool diagnostics = json_is_true(json_object_get(root, "diagnostics"));
    for (size_t p = 0; p < replay->result_count; p++) {
        json_t *work = json_object_get(json_array_get(json_object_get(root, "passes"), p), "work"), *items;
        json_t *lists = json_object_get(work, "lists");
        json_int_t texels = json_integer_value(json_object_get(work, "texels"));
        const char *name, *reasons = end_reasons_of(replay->results[p].pass);
        uint64_t found;
        struct glint_error own = {0};
        json_object_foreach(lists, name, items) {
            if (count_image(replay, name, &found, &own))
                json_object_set_new(lists, name, json_integer((json_int_t)found));
            if (own.code == GLINT_OK) texels += (json_int_t)found;
        }
        if (work && lists) json_object_set_new(work, "texels", json_integer(texels));
        if (diagnostics && reasons && replay->results[p].ran && count_image(replay, reasons, &found, &own))
            json_object_set_new(work, "rays", json_integer((json_int_t)found));
        if (own.code != GLINT_OK) return glint_fail(err, own.code, "%s", own.message);
    }
    return true;
}
