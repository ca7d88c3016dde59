/* Runs host passes, which fill small tables from the capture's attributes. */
#include "frame_plan.h"

#include <stdlib.h>
#include <string.h>

#include "format.h"

struct host_run {
    struct tables *tables;
    const struct pipeline_pass *entry;
};

static double host_value(const struct glint_host_context *context, const char *parameter) {
    const struct host_run *run = context->user;
    const double *value = pipeline_value(run->entry, parameter);
    return value ? *value : 0;
}

static struct glint_table *make_table(struct glint_host_context *context, const char *image, uint32_t width,
                                      uint32_t height, struct glint_error *err) {
    struct host_run *run = context->user;
    const struct glint_pass *pass = run->entry->pass;
    struct tables *tables = run->tables;
    const struct glint_row *row = glint_pass_output(pass, image);
    if (!row || tables_find(tables, image) || tables->count == TABLES_MAX) {
        glint_fail(err, GLINT_ERROR_USAGE, "%s/%s: cannot make table %s: it is not declared or already made",
                   pass->slot, pass->variant, image);
        return NULL;
    }
    if (width > 4096 || height > 4096) {
        glint_fail(err, GLINT_ERROR_LIMIT, "%s/%s: table %s of %u x %u, expected at most 4096 x 4096", pass->slot,
                   pass->variant, image, width, height);
        return NULL;
    }
    uint32_t components = format_components(row->format);
    uint32_t *texels = calloc((size_t)width * height * components + 1, sizeof *texels);
    if (!texels) {
        glint_fail(err, GLINT_ERROR_MEMORY, "table %s: out of memory", image);
        return NULL;
    }
    struct glint_table *table = &tables->tables[tables->count];
    *table = (struct glint_table){.name = row->name, .width = width, .height = height, .components = components};
    if (glint_format_is_uint(row->format)) table->texels.u = texels;
    else table->texels.f = (float *)texels;
    tables->makers[tables->count++] = pass;
    return table;
}

static bool check_all_made(const struct tables *tables, const struct glint_pass *pass, struct glint_error *err) {
    for (size_t i = 0; i < pass->row_count; i++)
        if (glint_row_is_output(&pass->rows[i]) && !tables_find(tables, pass->rows[i].name))
            return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s did not make its table %s", pass->slot, pass->variant,
                              pass->rows[i].name);
    return true;
}

static bool has_run(const struct tables *tables, const struct glint_pass *pass) {
    for (size_t i = 0; i < tables->count; i++)
        if (tables->makers[i] == pass) return true;
    return false;
}

bool tables_fill(struct tables *tables, const struct graph *graph, const struct frame_source *source,
                 struct glint_error *err) {
    const struct glint_frame *frame = glint_capture_frame(source->capture);
    struct glint_cubemap *cubemaps = calloc(source->cubemap_count + 1, sizeof *cubemaps);
    bool ok = cubemaps || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; ok && i < source->cubemap_count; i++) cubemaps[i] = source->cubemaps[i]->cubemap;
    for (size_t i = 0; ok && i < graph->pass_count; i++) {
        const struct graph_pass *pass = &graph->passes[i];
        if (!pass->runs || !pass->pass->host || has_run(tables, pass->pass)) continue;
        struct host_run run = {tables, pass->entry};
        struct glint_host_context context = {.frame = frame,
                                             .cubemaps = cubemaps,
                                             .cubemap_count = source->cubemap_count,
                                             .value = host_value,
                                             .table = make_table,
                                             .user = &run};
        glint_camera_position(&context.frame->camera, context.eye);
        const double start = glint_now_seconds();
        const size_t first = tables->count;
        ok = pass->pass->host(&context, err) && check_all_made(tables, pass->pass, err);
        for (size_t k = first; k < tables->count; k++) tables->seconds[k] = glint_now_seconds() - start;
    }
    free(cubemaps);
    return ok;
}

double tables_seconds(const struct tables *tables, const struct glint_pass *pass) {
    for (size_t i = 0; i < tables->count; i++)
        if (tables->makers[i] == pass) return tables->seconds[i];
    return 0;
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
