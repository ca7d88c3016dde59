/* Memory of a graph, and queries on it. */
#include "graph.h"

#include <stdlib.h>
#include <string.h>

struct graph_image *graph_find(const struct graph *graph, const char *name) {
    for (size_t i = 0; i < graph->image_count; i++)
        if (strcmp(graph->images[i].name, name) == 0 ||
            (graph->images[i].alias && strcmp(graph->images[i].alias->name, name) == 0))
            return &graph->images[i];
    return NULL;
}

struct graph_image *graph_bound(const struct graph *graph, const struct glint_row *binding) {
    for (size_t i = 0; binding->kind == GLINT_ROW_HISTORY && i < graph->image_count; i++)
        if (graph->images[i].history && strcmp(graph->images[i].name + strlen(HISTORY_PREFIX), binding->image) == 0)
            return &graph->images[i];
    return binding->kind == GLINT_ROW_HISTORY ? NULL : graph_find(graph, row_image(binding));
}

size_t graph_maker(const struct graph *graph, const char *image) {
    size_t i = 0;
    while (i < graph->pass_count && !glint_pass_output(graph->passes[i].pass, image)) i++;
    return i;
}

const struct glint_row *graph_row(const struct graph *graph, const char *name, const struct glint_pass **pass) {
    const size_t maker = graph_maker(graph, name);
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    *pass = maker < graph->pass_count ? graph->passes[maker].pass : NULL;
    const struct glint_row *row = *pass ? glint_pass_output(*pass, name) : capture_row(name);
    for (size_t i = 0; i < count && !row; i++)
        if ((row = glint_pass_output(&all[i], name))) *pass = &all[i];
    return row;
}

bool graph_allocate(struct graph *graph, const struct glint_pipeline *pipeline, struct glint_error *err) {
    size_t images = 0;
    for (size_t i = 0; i < pipeline->count; i++) images += 3 * pipeline->passes[i].pass->row_count;
    *graph = (struct graph){.pipeline = pipeline, .pass_count = pipeline->count};
    graph->passes = calloc(pipeline->count + 1, sizeof *graph->passes);
    graph->images = calloc(images + 1, sizeof *graph->images);
    if (graph->passes && graph->images) return true;
    graph_finish(graph);
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

bool graph_copy(struct graph *copy, const struct graph *graph, struct glint_error *err) {
    if (!graph_allocate(copy, graph->pipeline, err)) return false;
    memcpy(copy->passes, graph->passes, graph->pass_count * sizeof *copy->passes);
    copy->declared = copy->faults = graph->declared;
    return true;
}

uint64_t pass_rays(const struct graph *graph, const struct graph_pass *pass) {
    return pass->rank == RANK_RAY ? glint_pipeline_rays(graph->pipeline) : 1;
}

void graph_finish(struct graph *graph) {
    free(graph->passes);
    free(graph->images);
    *graph = (struct graph){0};
}
