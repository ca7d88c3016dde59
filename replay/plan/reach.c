/* Finds cube-map images that are sampled only along known rays. Rays are known if all visible ones are mirror rays; the survey then traces which
   faces they reach, as seen from the centre of each cube map. */
#include <stdlib.h>
#include <string.h>

#include "planner.h"

static const struct glint_row *find_along_rays(const struct glint_pass *pass, const char *image) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_ALONG_RAYS && strcmp(pass->rows[r].name, image) == 0) return &pass->rows[r];
    return NULL;
}

/* Whether the image is as it is in the capture: no pass that runs makes it in place of that. */
static bool is_captured(const struct graph *graph, const char *image) {
    const size_t maker = graph_maker(graph, image);
    return capture_row(image) && (maker == graph->pass_count || !graph->passes[maker].runs);
}

/* Whether the pass samples the image only along rays that follow from the capture's own normals. A user's shader may sample anywhere. */
static bool samples_along_rays(const struct graph *graph, const struct graph_pass *reader, const char *image) {
    const struct glint_row *row = reader->entry->shader ? NULL : find_along_rays(reader->pass, image);
    if (!row || is_captured(graph, row->image)) return row != NULL;
    const size_t maker = graph_maker(graph, row->image);
    if (maker == graph->pass_count || !graph->passes[maker].runs || graph->passes[maker].entry->shader) return false;
    row = find_along_rays(graph->passes[maker].pass, row->image);
    return row && is_captured(graph, row->image);
}

bool graph_is_along_rays(const struct graph *graph, const char *image) {
    for (size_t i = 0; i < graph->pass_count; i++)
        if (graph->passes[i].runs && glint_pass_row(graph->passes[i].pass, GLINT_ROW_READ, image) &&
            !samples_along_rays(graph, &graph->passes[i], image))
            return false;
    return true;
}

static bool is_limited(const struct graph *graph, const struct graph_pass *pass) {
    for (size_t r = 0; r < pass->pass->row_count; r++)
        if (glint_row_is_output(&pass->pass->rows[r]) && !graph_is_along_rays(graph, pass->pass->rows[r].name))
            return false;
    return glint_pass_row(pass->pass, GLINT_ROW_RAY_MARGIN, NULL);
}

bool plan_reach(struct frame_plan *plan, const struct glint_survey *survey, struct glint_error *err) {
    const struct graph *graph = &plan->graph;
    struct reach *reach = &plan->reach;
    reach->known = !plan->options->all && plan->sizes.active && survey->active_traced == plan->sizes.active;
    if (!reach->known) return true;
    reach->captured = calloc(graph->image_count + 1, sizeof *reach->captured);
    reach->limited = calloc(graph->pass_count + 1, sizeof *reach->limited);
    if (!reach->captured || !reach->limited) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (uint32_t i = 0; i < survey->active_traced; i++)
        reach->crossed[i] = survey->active[i].crossed, reach->nearby[i] = survey->active[i].nearby;
    for (size_t i = 0; i < graph->image_count; i++)
        reach->captured[i] = graph->images[i].source == SOURCE_CAPTURE && size_is_array(graph->images[i].row->size) &&
                             graph_is_along_rays(graph, graph->images[i].name);
    for (size_t p = 0; p < graph->pass_count; p++) reach->limited[p] = is_limited(graph, &graph->passes[p]);
    return true;
}
