/* Counts work: texels of the passes' dispatches without culling, and cube-map faces with and without it. */
#include "planner.h"

#include <stdlib.h>
#include <string.h>

/* The texels of all dispatches of a pass without culling. */
static uint64_t count_texels(const struct frame_plan *plan, const struct graph_pass *entry, struct glint_error *err) {
    const struct glint_pass *pass = entry->pass;
    uint64_t texels = 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!row_is_dispatch(row)) continue;
        struct graph_image image = {.name = row->name, .source = SOURCE_MADE};
        struct image_desc desc;
        uint32_t first = 0, last = 0;
        if (!(image.row = graph_row(&plan->graph, row->name, &image.pass)) || !plan_describe(plan, &image, &desc, err))
            return 0;
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS && !dispatch_levels(&plan->sizes, entry, row, &desc, &first, &last))
            continue;
        for (uint32_t level = first; level <= last; level += row_levels(row, plan->sizes.is_cpu))
            texels += dispatch_texels(&plan->sizes, &desc, level);
    }
    return texels;
}

static uint64_t count_all_faces(const struct frame_plan *plan, enum glint_size_class size) {
    return size_is_array(size) ? 6 * (uint64_t)plan->sizes.active : plan->sizes.sky_face ? 6 : 0;
}

/* The number of faces of an image that a pass makes: those of the dispatches over that image, or over any image if there are none. The coarsest
   MIP level needs the most faces. */
static uint64_t count_made_faces(const struct frame_plan *plan, const struct graph_pass *entry,
                                 const struct glint_row *made) {
    const struct glint_pass *pass = entry->pass;
    uint8_t faces[GLINT_SURVEY_CUBEMAPS] = {0};
    bool own = false;
    for (size_t r = 0; r < pass->row_count; r++)
        own |= row_is_dispatch(&pass->rows[r]) && strcmp(pass->rows[r].name, made->name) == 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!row_is_dispatch(row) || (own && strcmp(row->name, made->name) != 0)) continue;
        const struct graph_image image = {
            .name = row->name, .row = glint_pass_output(pass, row->name), .source = SOURCE_MADE};
        struct image_desc desc;
        uint8_t more[GLINT_SURVEY_CUBEMAPS];
        uint32_t first, last = 0;
        if (!image.row || !plan_describe(plan, &image, &desc, NULL)) return count_all_faces(plan, made->size);
        if (row->kind == GLINT_ROW_DISPATCH_LEVELS && !dispatch_levels(&plan->sizes, entry, row, &desc, &first, &last))
            continue;
        if (!plan_dispatched_faces(plan, entry, row, last, more)) return count_all_faces(plan, made->size);
        for (uint32_t i = 0; i < plan->sizes.active && i < GLINT_SURVEY_CUBEMAPS; i++) faces[i] |= more[i];
    }
    return count_faces(faces, plan->sizes.active);
}

static void count_cube_faces(const struct frame_plan *plan, struct glint_cube_faces *faces) {
    uint8_t some[GLINT_SURVEY_CUBEMAPS];
    faces->uploaded = faces->filtered = 0;
    for (size_t i = 0; i < plan->graph.image_count; i++) {
        const struct graph_image *image = &plan->graph.images[i];
        if (image->source == SOURCE_CAPTURE && size_is_cube(image->row->size))
            faces->uploaded += plan_captured_faces(plan, i, some) ? count_faces(some, plan->sizes.active)
                                                                  : count_all_faces(plan, image->row->size);
    }
    for (size_t p = 0; p < plan->graph.pass_count; p++) {
        const struct graph_pass *pass = &plan->graph.passes[p];
        for (size_t r = 0; pass->runs && r < pass->pass->row_count; r++)
            if (pass->pass->rows[r].kind == GLINT_ROW_WRITE && size_is_cube(pass->pass->rows[r].size) &&
                graph_find(&plan->graph, pass->pass->rows[r].name)->source == SOURCE_MADE)
                faces->filtered += count_made_faces(plan, pass, &pass->pass->rows[r]);
    }
}

/* Plans the same graph with all of its passes and without culling. What it needs stays unknown if it cannot be linked. */
static bool find_whole_work(struct frame_plan *plan, const struct graph_inputs *inputs, struct glint_error *err) {
    struct glint_replay_options all = *plan->options;
    struct glint_error ignored = {0};
    struct glint_cube_faces faces = {0};
    struct frame_plan whole = {.pipeline = plan->pipeline,
                               .options = &all,
                               .source = plan->source,
                               .inputs = plan->inputs,
                               .tables = plan->tables,
                               .is_cpu = plan->is_cpu};
    struct graph_inputs whole_inputs = *inputs;
    whole_inputs.options = &all;
    all.all = true;
    all.outputs = NULL;
    const bool ok =
        graph_copy(&whole.graph, &plan->graph, &ignored) && graph_decide(&whole.graph, &whole_inputs, &ignored) &&
        graph_link(&whole.graph, &whole_inputs, &ignored) &&
        tables_fill(whole.tables, &whole.graph, plan->source, &ignored) && plan_find_sizes(&whole, &ignored);
    for (size_t p = 0; ok && p < whole.graph.pass_count; p++)
        plan->whole[p] = (struct whole_work){count_texels(&whole, &whole.graph.passes[p], &ignored) *
                                                 pass_rays(&whole.graph, &whole.graph.passes[p]),
                                             whole.graph.passes[p].cached_work};
    if (ok) count_cube_faces(&whole, &faces);
    plan->faces = (struct glint_cube_faces){.uploaded_of = faces.uploaded, .filtered_of = faces.filtered};
    whole.inputs = NULL; /* owned by the plan */
    frame_plan_finish(&whole);
    return ignored.code != GLINT_ERROR_MEMORY || glint_fail(err, ignored.code, "%s", ignored.message);
}

bool plan_workload(struct frame_plan *plan, const struct graph_inputs *inputs, bool sized, struct glint_error *err) {
    plan->whole = calloc(plan->graph.pass_count + 1, sizeof *plan->whole);
    if (!plan->whole) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (!find_whole_work(plan, inputs, err)) return false;
    if (sized) count_cube_faces(plan, &plan->faces);
    return true;
}
