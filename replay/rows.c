/* Look-ups in declarations, and in graphs by name. */
#include "graph.h"

#include <string.h>

bool row_is_output(const struct glint_row *row) {
    return row->kind == GLINT_ROW_WRITE || row->kind == GLINT_ROW_DIAGNOSTIC;
}
bool row_is_sampled(const struct glint_row *row) {
    return row->kind == GLINT_ROW_READ || row->kind == GLINT_ROW_READ_OWN || row->kind == GLINT_ROW_HISTORY;
}
bool row_is_image(const struct glint_row *row) {
    return row_is_sampled(row) || row_is_output(row);
}
const char *row_image(const struct glint_row *row) {
    return row->image ? row->image : row->name;
}

bool size_is_array(enum glint_size_class size) {
    return size == GLINT_SIZE_CUBEMAPS || size == GLINT_SIZE_CUBEMAPS_MIPS || size == GLINT_SIZE_COCOON ||
           size == GLINT_SIZE_PARABOLOIDS_MIPS;
}
bool size_is_cube(enum glint_size_class size) {
    return (size_is_array(size) && size != GLINT_SIZE_PARABOLOIDS_MIPS) || size == GLINT_SIZE_SKY ||
           size == GLINT_SIZE_SKY_MIPS;
}
bool size_has_levels(enum glint_size_class size) {
    return size == GLINT_SIZE_FULL_MIPS || size == GLINT_SIZE_HALF_MIPS || size == GLINT_SIZE_CUBEMAPS_MIPS ||
           size == GLINT_SIZE_SKY_MIPS || size == GLINT_SIZE_PARABOLOIDS_MIPS || size == GLINT_SIZE_HALF_MIPS3;
}

bool size_is_buffer(enum glint_size_class size) {
    return size == GLINT_SIZE_LIST || size == GLINT_SIZE_TILES;
}

bool list_has(const char *const *list, const char *name) {
    for (; list && *list; list++)
        if (strcmp(*list, name) == 0) return true;
    return false;
}

struct graph_image *graph_find(const struct graph *graph, const char *name) {
    for (size_t i = 0; i < graph->image_count; i++)
        if (strcmp(graph->images[i].name, name) == 0 ||
            (graph->images[i].instead && strcmp(graph->images[i].instead->name, name) == 0))
            return &graph->images[i];
    return NULL;
}

struct graph_image *graph_bound(const struct graph *graph, const struct glint_row *binding) {
    for (size_t i = 0; binding->kind == GLINT_ROW_HISTORY && i < graph->image_count; i++)
        if (graph->images[i].history && strcmp(graph->images[i].name + strlen(HISTORY_PREFIX), binding->image) == 0)
            return &graph->images[i];
    return binding->kind == GLINT_ROW_HISTORY ? NULL : graph_find(graph, row_image(binding));
}

const struct glint_row *pass_row(const struct glint_pass *pass, enum glint_row_kind kind, const char *image) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == kind && (!image || strcmp(row_image(&pass->rows[r]), image) == 0))
            return &pass->rows[r];
    return NULL;
}

const struct glint_row *pass_output(const struct glint_pass *pass, const char *image) {
    for (size_t i = 0; i < pass->row_count; i++)
        if (row_is_output(&pass->rows[i]) && strcmp(pass->rows[i].name, image) == 0) return &pass->rows[i];
    return NULL;
}

const struct glint_row *capture_row(const char *image) {
    size_t count;
    const struct glint_row *rows = glint_capture_images(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(rows[i].name, image) == 0) return &rows[i];
    return NULL;
}

size_t graph_maker(const struct graph *graph, const char *image) {
    size_t i = 0;
    while (i < graph->pass_count && !pass_output(graph->passes[i].pass, image)) i++;
    return i;
}
