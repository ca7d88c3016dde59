/* Pipelines. Every change is checked against the declarations. */
#include "pipeline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "row.h"
#include "shared/work_list.h"

const struct pipeline_pass *pipeline_find(const struct glint_pipeline *pipeline, const char *slot) {
    for (size_t i = 0; i < pipeline->count; i++)
        if (strcmp(pipeline->passes[i].pass->slot, slot) == 0) return &pipeline->passes[i];
    return NULL;
}

static struct pipeline_pass *find_entry(struct glint_pipeline *pipeline, const char *slot) {
    return (struct pipeline_pass *)pipeline_find(pipeline, slot); /* safe, since the caller's pipeline is not const */
}

static void pass_finish(struct pipeline_pass *pass) {
    free(pass->values);
    free(pass->shader);
    *pass = (struct pipeline_pass){0};
}

static bool out_of_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static bool pass_init(struct pipeline_pass *entry, const struct glint_pass *pass, struct glint_error *err) {
    double *values = calloc(pass->row_count, sizeof *values);
    if (!values) return out_of_memory(err);
    for (size_t i = 0; i < pass->row_count; i++)
        values[i] = glint_row_is_parameter(&pass->rows[i]) ? pass->rows[i].initial : 0;
    *entry = (struct pipeline_pass){.pass = pass, .values = values};
    return true;
}

/* Parameters that the new variant shares with the old one keep their values, unless these were the old defaults. */
bool pipeline_use(struct glint_pipeline *pipeline, const char *slot, const char *variant, struct glint_error *err) {
    struct pipeline_pass *old = find_entry(pipeline, slot);
    if (strcmp(variant, GLINT_NO_VARIANT) == 0 && !glint_pass_find(slot, variant)) {
        if (!old) return glint_slot_check(slot, err);
        pass_finish(old);
        size_t place = (size_t)(old - pipeline->passes);
        memmove(old, old + 1, (--pipeline->count - place) * sizeof *old);
        return true;
    }
    const struct glint_pass *pass = glint_pass_find(slot, variant);
    struct pipeline_pass fresh = {0};
    if (!glint_variant_check(slot, variant, err) || !pass_init(&fresh, pass, err)) return false;
    if (old) {
        for (size_t i = 0; i < pass->row_count; i++)
            for (size_t j = 0; glint_row_is_parameter(&pass->rows[i]) && j < old->pass->row_count; j++)
                if (glint_row_is_parameter(&old->pass->rows[j]) &&
                    strcmp(old->pass->rows[j].name, pass->rows[i].name) == 0 &&
                    old->values[j] != old->pass->rows[j].initial && old->values[j] >= pass->rows[i].lowest &&
                    old->values[j] <= pass->rows[i].highest)
                    fresh.values[i] = old->values[j];
        pass_finish(old);
        *old = fresh;
        return true;
    }
    struct pipeline_pass *larger = realloc(pipeline->passes, (pipeline->count + 1) * sizeof *larger);
    if (!larger) {
        pass_finish(&fresh);
        return out_of_memory(err);
    }
    pipeline->passes = larger;
    size_t place = 0;
    while (place < pipeline->count && strcmp(larger[place].pass->slot, slot) < 0) place++;
    memmove(&larger[place + 1], &larger[place], (pipeline->count++ - place) * sizeof *larger);
    larger[place] = fresh;
    return true;
}

uint32_t glint_pipeline_first_ray(const struct glint_pipeline *pipeline) {
    return pipeline->first_ray;
}
uint32_t glint_pipeline_rays(const struct glint_pipeline *pipeline) {
    return pipeline->rays ? pipeline->rays : 1;
}

void glint_pipeline_destroy(struct glint_pipeline **pointer) {
    struct glint_pipeline *pipeline = *pointer;
    *pointer = NULL;
    if (!pipeline) return;
    for (size_t i = 0; i < pipeline->count; i++) pass_finish(&pipeline->passes[i]);
    free(pipeline->passes);
    free(pipeline->name);
    free(pipeline);
}

struct glint_pipeline *glint_pipeline_copy(const struct glint_pipeline *pipeline, struct glint_error *err) {
    struct glint_pipeline *copy = calloc(1, sizeof *copy);
    bool ok = copy && (copy->name = strdup(pipeline->name)) &&
              (copy->passes = calloc(pipeline->count + 1, sizeof *copy->passes));
    if (ok) copy->rays = pipeline->rays, copy->first_ray = pipeline->first_ray;
    for (size_t i = 0; ok && i < pipeline->count; i++) {
        const struct pipeline_pass *from = &pipeline->passes[i];
        struct pipeline_pass *to = &copy->passes[copy->count++];
        if (!(ok = pass_init(to, from->pass, err))) return glint_pipeline_destroy(&copy), NULL;
        memcpy(to->values, from->values, from->pass->row_count * sizeof *to->values);
        ok = !from->shader || (to->shader = strdup(from->shader));
    }
    if (ok) return copy;
    out_of_memory(err);
    if (copy) glint_pipeline_destroy(&copy);
    return NULL;
}

const char *glint_pipeline_name(const struct glint_pipeline *pipeline) {
    return pipeline->name;
}
size_t glint_pipeline_pass_count(const struct glint_pipeline *pipeline) {
    return pipeline->count;
}
const struct glint_pass *glint_pipeline_pass(const struct glint_pipeline *pipeline, size_t i) {
    return i < pipeline->count ? pipeline->passes[i].pass : NULL;
}

const struct glint_pass *glint_pipeline_find(const struct glint_pipeline *pipeline, const char *slot) {
    const struct pipeline_pass *entry = pipeline_find(pipeline, slot);
    return entry ? entry->pass : NULL;
}

const char *glint_pipeline_shader_file(const struct glint_pipeline *pipeline, const struct glint_pass *pass) {
    const struct pipeline_pass *entry = pipeline_find(pipeline, pass->slot);
    return entry && entry->pass == pass ? entry->shader : NULL;
}

double glint_pipeline_value(const struct glint_pipeline *pipeline, const struct glint_pass *pass,
                            const struct glint_row *parameter) {
    const struct pipeline_pass *entry = pipeline_find(pipeline, pass->slot);
    if (!entry || entry->pass != pass || parameter < pass->rows || parameter >= pass->rows + pass->row_count) return 0;
    return entry->values[parameter - pass->rows];
}

const double *pipeline_value(const struct pipeline_pass *entry, const char *parameter) {
    return parameter_value(entry->pass, entry->values, parameter);
}

void pipeline_classes(const struct glint_pipeline *pipeline, float *smooth, float *rough) {
    *smooth = -1, *rough = INFINITY;
    for (size_t p = 0; p < pipeline->count; p++) {
        const struct glint_pass *pass = pipeline->passes[p].pass;
        for (size_t r = 0; r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            const double *limit = row->kind == GLINT_ROW_DISPATCH_LIST && row->image
                                      ? pipeline_value(&pipeline->passes[p], row->image)
                                      : NULL;
            if (limit && row->first == RANGE_smooth) *smooth = fmaxf(*smooth, (float)*limit);
            if (limit && row->first == RANGE_rough) *rough = fminf(*rough, (float)*limit);
        }
    }
}

bool pipeline_shows_all(const struct glint_pipeline *pipeline) {
    for (size_t p = 0; p < pipeline->count; p++) {
        const struct glint_row *row = glint_pass_row(pipeline->passes[p].pass, GLINT_ROW_ALL_VISIBLE_UNLESS, NULL);
        const double *value = row ? pipeline_value(&pipeline->passes[p], row->name) : NULL;
        if (value && *value == 0) return true;
    }
    return false;
}

bool pipeline_traces_all_pixels(const struct glint_pipeline *pipeline) {
    for (size_t p = 0; p < pipeline->count; p++)
        if (glint_pass_row(pipeline->passes[p].pass, GLINT_ROW_RESOLUTION, NULL)) return true;
    return false;
}
