/* Host passes: small tables made from the capture's attributes. */
#include "tables.h"

#include <stdlib.h>
#include <string.h>

#include "device.h"
#include "frame_block.h"
#include "timing.h"

struct host_run {
    struct tables *tables;
    const struct pipeline_pass *entry;
};

static double value_of(const struct glint_host_context *context, const char *parameter) {
    const struct host_run *run = context->user;
    const struct glint_pass *pass = run->entry->pass;
    for (size_t i = 0; i < pass->row_count; i++)
        if (row_is_parameter(&pass->rows[i]) && strcmp(pass->rows[i].name, parameter) == 0)
            return run->entry->values[i];
    return 0;
}

static struct glint_table *make_table(struct glint_host_context *context, const char *image, uint32_t width,
                                      uint32_t height, struct glint_error *err) {
    struct host_run *run = context->user;
    const struct glint_pass *pass = run->entry->pass;
    struct tables *tables = run->tables;
    size_t i = 0;
    while (i < pass->row_count && (!row_is_output(&pass->rows[i]) || strcmp(pass->rows[i].name, image) != 0)) i++;
    if (i == pass->row_count || tables_find(tables, image) || tables->count == TABLES_MAX) {
        glint_fail(err, GLINT_ERROR_USAGE, "%s/%s: cannot make table %s: not declared, or made already", pass->slot,
                   pass->variant, image);
        return NULL;
    }
    if (width > 4096 || height > 4096) {
        glint_fail(err, GLINT_ERROR_LIMIT, "%s/%s: table %s of %u x %u, expected at most 4096 x 4096", pass->slot,
                   pass->variant, image, width, height);
        return NULL;
    }
    uint32_t components = format_components(pass->rows[i].format);
    uint32_t *texels = calloc((size_t)width * height * components + 1, sizeof *texels);
    if (!texels) {
        glint_fail(err, GLINT_ERROR_MEMORY, "table %s: out of memory", image);
        return NULL;
    }
    struct glint_table *table = &tables->tables[tables->count];
    *table =
        (struct glint_table){.name = pass->rows[i].name, .width = width, .height = height, .components = components};
    if (format_is_uint(pass->rows[i].format)) table->texels.u = texels;
    else table->texels.f = (float *)texels;
    tables->rows[tables->count++] = &pass->rows[i];
    return table;
}

static int by_number(const void *a, const void *b) {
    const struct glint_part_info *const *left = a, *const *right = b;
    return ((*left)->index > (*right)->index) - ((*left)->index < (*right)->index);
}

bool cubemap_parts(const struct glint_capture *capture, const struct glint_part_info ***parts, size_t *count,
                   struct glint_error *err) {
    size_t part_count = glint_capture_part_count(capture);
    *count = 0;
    *parts = calloc(part_count + 1, sizeof **parts);
    if (!*parts) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < part_count; i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (part->has_cubemap && !part->previous) (*parts)[(*count)++] = part;
    }
    qsort(*parts, *count, sizeof **parts, by_number);
    return true;
}

static bool check_all_made(const struct tables *tables, const struct glint_pass *pass, struct glint_error *err) {
    for (size_t i = 0; i < pass->row_count; i++)
        if (row_is_output(&pass->rows[i]) && !tables_find(tables, pass->rows[i].name))
            return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s did not make its table %s", pass->slot, pass->variant,
                              pass->rows[i].name);
    return true;
}

bool tables_init(struct tables *tables, const struct graph *graph, struct glint_capture *capture, double *seconds,
                 struct glint_error *err) {
    const struct glint_part_info **parts = NULL;
    struct glint_cubemap *cubemaps = NULL;
    size_t count = 0;
    *tables = (struct tables){0};
    bool ok = cubemap_parts(capture, &parts, &count, err);
    if (ok && !(cubemaps = calloc(count + 1, sizeof *cubemaps)))
        ok = glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; ok && i < count; i++) cubemaps[i] = parts[i]->cubemap;
    for (size_t i = 0; ok && i < graph->pass_count; i++) {
        const struct graph_pass *pass = &graph->passes[i];
        if (!pass->runs || !pass->pass->host) continue;
        struct host_run run = {tables, pass->entry};
        struct glint_host_context context = {.frame = glint_capture_frame(capture),
                                             .cubemaps = cubemaps,
                                             .cubemap_count = count,
                                             .value = value_of,
                                             .table = make_table,
                                             .user = &run};
        glint_camera_position(&context.frame->camera, context.eye);
        double start = now_seconds();
        ok = pass->pass->host(&context, err) && check_all_made(tables, pass->pass, err);
        seconds[i] = now_seconds() - start;
    }
    free(parts);
    free(cubemaps);
    if (!ok) tables_finish(tables);
    return ok;
}

void tables_finish(struct tables *tables) {
    for (size_t i = 0; i < tables->count; i++) free(tables->tables[i].texels.u);
    *tables = (struct tables){0};
}

const struct glint_table *tables_find(const struct tables *tables, const char *image) {
    for (size_t i = 0; i < tables->count; i++)
        if (strcmp(tables->tables[i].name, image) == 0) return &tables->tables[i];
    return NULL;
}
