/* Pipelines: every change is checked against the declarations. */
#include "pipeline.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "faults.h"
#include "graph.h"

bool row_is_parameter(const struct glint_row *row) {
    return row->kind == GLINT_ROW_SPEC || row->kind == GLINT_ROW_CHOICE || row->kind == GLINT_ROW_PUSH;
}

const struct pipeline_pass *pipeline_find(const struct glint_pipeline *pipeline, const char *slot) {
    for (size_t i = 0; i < pipeline->count; i++)
        if (strcmp(pipeline->passes[i].pass->slot, slot) == 0) return &pipeline->passes[i];
    return NULL;
}

static struct pipeline_pass *find(struct glint_pipeline *pipeline, const char *slot) {
    return (struct pipeline_pass *)pipeline_find(pipeline, slot); /* the caller's pipeline is not const */
}

static void pass_finish(struct pipeline_pass *pass) {
    free(pass->values);
    free(pass->shader);
    *pass = (struct pipeline_pass){0};
}

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static bool pass_init(struct pipeline_pass *entry, const struct glint_pass *pass, struct glint_error *err) {
    double *values = calloc(pass->row_count, sizeof *values);
    if (!values) return no_memory(err);
    for (size_t i = 0; i < pass->row_count; i++)
        values[i] = row_is_parameter(&pass->rows[i]) ? pass->rows[i].initial : 0;
    *entry = (struct pipeline_pass){.pass = pass, .values = values};
    return true;
}

static bool unknown_slot(const char *slot, struct glint_error *err) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    char known[512] = "";
    for (size_t i = 0; i < count; i++)
        if (i == 0 || strcmp(all[i].slot, all[i - 1].slot) != 0) text_list(known, sizeof known, all[i].slot);
    return glint_fail(err, GLINT_ERROR_USAGE, "unknown slot '%s'; known: %s", slot, known);
}

static bool unknown_variant(const char *slot, const char *variant, struct glint_error *err) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    char known[512] = "";
    for (size_t i = 0; i < count; i++)
        if (strcmp(all[i].slot, slot) == 0) text_list(known, sizeof known, all[i].variant);
    if (!known[0]) return unknown_slot(slot, err);
    return glint_fail(err, GLINT_ERROR_USAGE, "slot %s has no variant '%s'; known: %s, none", slot, variant, known);
}

/* Puts the variant into the slot; parameters of the old variant that the new one has too keep their values. */
bool pipeline_use(struct glint_pipeline *pipeline, const char *slot, const char *variant, struct glint_error *err) {
    struct pipeline_pass *old = find(pipeline, slot);
    if (strcmp(variant, "none") == 0 && !glint_pass_find(slot, "none")) {
        size_t count, i = 0;
        const struct glint_pass *all = glint_passes(&count);
        while (i < count && strcmp(all[i].slot, slot) != 0) i++;
        if (i == count) return unknown_slot(slot, err);
        if (!old) return true;
        pass_finish(old);
        size_t place = (size_t)(old - pipeline->passes);
        memmove(old, old + 1, (--pipeline->count - place) * sizeof *old);
        return true;
    }
    const struct glint_pass *pass = glint_pass_find(slot, variant);
    if (!pass) return unknown_variant(slot, variant, err);
    struct pipeline_pass fresh = {0};
    if (!pass_init(&fresh, pass, err)) return false;
    if (old) {
        for (size_t i = 0; i < pass->row_count; i++)
            for (size_t j = 0; row_is_parameter(&pass->rows[i]) && j < old->pass->row_count; j++)
                if (row_is_parameter(&old->pass->rows[j]) && strcmp(old->pass->rows[j].name, pass->rows[i].name) == 0 &&
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
        return no_memory(err);
    }
    pipeline->passes = larger;
    size_t place = 0;
    while (place < pipeline->count && strcmp(larger[place].pass->slot, slot) < 0) place++;
    memmove(&larger[place + 1], &larger[place], (pipeline->count++ - place) * sizeof *larger);
    larger[place] = fresh;
    return true;
}

static size_t find_parameter(const struct glint_pass *pass, const char *name) {
    size_t i = 0;
    while (i < pass->row_count && (!row_is_parameter(&pass->rows[i]) || strcmp(pass->rows[i].name, name) != 0)) i++;
    return i;
}

/* The entry and row of slot.parameter. */
static struct pipeline_pass *locate(struct glint_pipeline *pipeline, const char *slot, const char *parameter,
                                    size_t *row, struct glint_error *err) {
    struct pipeline_pass *entry = find(pipeline, slot);
    if (!entry) {
        size_t count, i = 0;
        const struct glint_pass *all = glint_passes(&count);
        while (i < count && strcmp(all[i].slot, slot) != 0) i++;
        if (i == count) unknown_slot(slot, err);
        else glint_fail(err, GLINT_ERROR_USAGE, "slot %s is not part of the pipeline %s", slot, pipeline->name);
        return NULL;
    }
    *row = find_parameter(entry->pass, parameter);
    if (*row < entry->pass->row_count) return entry;
    char known[512] = "";
    for (size_t i = 0; i < entry->pass->row_count; i++)
        if (row_is_parameter(&entry->pass->rows[i])) text_list(known, sizeof known, entry->pass->rows[i].name);
    glint_fail(err, GLINT_ERROR_USAGE, "%s/%s has no parameter '%s'; known: %s", slot, entry->pass->variant, parameter,
               known[0] ? known : "none at all");
    return NULL;
}

static bool set_number(struct glint_pipeline *pipeline, const char *slot, const char *parameter, double value,
                       struct glint_error *err) {
    size_t i;
    struct pipeline_pass *entry = locate(pipeline, slot, parameter, &i, err);
    if (!entry) return false;
    const struct glint_row *row = &entry->pass->rows[i];
    if (!(value >= row->lowest && value <= row->highest))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s.%s: expected %g to %g (%s), found %g", slot, parameter,
                          row->lowest, row->highest, row->unit, value);
    if (row->type != GLINT_VALUE_FLOAT && value != floor(value))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s.%s: expected a whole number from %g to %g (%s), found %g", slot,
                          parameter, row->lowest, row->highest, row->unit, value);
    entry->values[i] = value;
    return true;
}

uint32_t glint_pipeline_rays(const struct glint_pipeline *pipeline) {
    return pipeline->rays ? pipeline->rays : 1;
}

static bool set_rays(struct glint_pipeline *pipeline, const char *parameter, const char *text,
                     struct glint_error *err) {
    const bool first = strcmp(parameter, "first_ray") == 0;
    const int lowest = first ? 0 : 1, highest = first ? FIRST_RAY_MAX : RAYS_MAX;
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end || !(value >= lowest && value <= highest) || value != floor(value))
        return glint_fail(err, GLINT_ERROR_USAGE, "pipeline.%s: expected a whole number from %d to %d, found '%s'",
                          parameter, lowest, highest, text);
    *(first ? &pipeline->first_ray : &pipeline->rays) = (uint32_t)value;
    return true;
}

static bool has_parameter(const struct glint_pass *pass, const char *parameter) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (row_is_parameter(&pass->rows[r]) && strcmp(pass->rows[r].name, parameter) == 0) return true;
    return false;
}

static bool set_text(struct glint_pipeline *pipeline, const char *slot, const char *parameter, const char *text,
                     struct glint_error *err);

/* pipeline.rays and pipeline.first_ray are the pipeline's own. Any other name is set in each pass that has it, which may
   be none of this pipeline: a switch that is off in all of them is off. */
static bool set_everywhere(struct glint_pipeline *pipeline, const char *parameter, const char *text,
                           struct glint_error *err) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    bool known = false;
    if (!strcmp(parameter, "rays") || !strcmp(parameter, "first_ray")) return set_rays(pipeline, parameter, text, err);
    for (size_t i = 0; i < count && !known; i++) known = has_parameter(&all[i], parameter);
    if (!known)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "pipeline has no parameter '%s'; known: rays, first_ray, and those that any pass has",
                          parameter);
    for (size_t i = 0; i < pipeline->count; i++)
        if (has_parameter(pipeline->passes[i].pass, parameter) &&
            !set_text(pipeline, pipeline->passes[i].pass->slot, parameter, text, err))
            return false;
    return true;
}

static bool set_text(struct glint_pipeline *pipeline, const char *slot, const char *parameter, const char *text,
                     struct glint_error *err) {
    size_t i;
    if (strcmp(slot, "pipeline") == 0) return set_everywhere(pipeline, parameter, text, err);
    struct pipeline_pass *entry = locate(pipeline, slot, parameter, &i, err);
    if (!entry) return false;
    const struct glint_row *row = &entry->pass->rows[i];
    char known[512] = "";
    for (size_t c = 0; row->choices && row->choices[c]; c++) {
        if (strcmp(row->choices[c], text) == 0) {
            entry->values[i] = (double)c;
            return true;
        }
        text_list(known, sizeof known, row->choices[c]);
    }
    if (row->choices)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s.%s: expected one of %s, found '%s'", slot, parameter, known,
                          text);
    if (row->type == GLINT_VALUE_BOOL) {
        bool on = strcmp(text, "true") == 0 || strcmp(text, "on") == 0,
             off = strcmp(text, "false") == 0 || strcmp(text, "off") == 0;
        if (on || off) {
            entry->values[i] = on;
            return true;
        }
    }
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s.%s: expected %s from %g to %g (%s), found '%s'", slot, parameter,
                          row->type == GLINT_VALUE_BOOL ? "true, false or a number" : "a number", row->lowest,
                          row->highest, row->unit, text);
    return set_number(pipeline, slot, parameter, value, err);
}

/* Splits "left=right" (and, for `dotted`, "slot.parameter=right") into a copy that the caller frees. */
static char *split(const char *assignment, bool dotted, const char *form, char **parameter, char **right,
                   struct glint_error *err) {
    char *copy = strdup(assignment);
    if (!copy) {
        no_memory(err);
        return NULL;
    }
    char *equals = strchr(copy, '='), *dot = dotted ? strchr(copy, '.') : NULL;
    if (!equals || equals == copy || !equals[1] ||
        (dotted && (!dot || dot > equals || dot == copy || dot + 1 == equals))) {
        glint_fail(err, GLINT_ERROR_USAGE, "expected %s, found '%s'", form, assignment);
        free(copy);
        return NULL;
    }
    *equals = 0;
    *right = equals + 1;
    if (dotted) *dot = 0, *parameter = dot + 1;
    return copy;
}

bool glint_pipeline_use(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err) {
    char *variant, *slot = split(assignment, false, "slot=variant", NULL, &variant, err);
    bool ok = slot && pipeline_use(pipeline, slot, variant, err);
    free(slot);
    return ok;
}

bool glint_pipeline_set(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err) {
    char *parameter, *value, *slot = split(assignment, true, "slot.parameter=value", &parameter, &value, err);
    bool ok = slot && set_text(pipeline, slot, parameter, value, err);
    free(slot);
    return ok;
}

bool glint_pipeline_shader(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err) {
    char *path, *slot = split(assignment, false, "slot=file.comp", NULL, &path, err), *copy = NULL;
    struct pipeline_pass *entry = slot ? find(pipeline, slot) : NULL;
    bool ok = false;
    if (!slot) return false;
    if (!entry) glint_fail(err, GLINT_ERROR_USAGE, "slot '%s' is not part of the pipeline %s", slot, pipeline->name);
    else if (entry->pass->host)
        glint_fail(err, GLINT_ERROR_USAGE, "%s/%s runs on the host and has no shader to replace", slot,
                   entry->pass->variant);
    else if (!(copy = strdup(path))) no_memory(err);
    else {
        free(entry->shader);
        entry->shader = copy;
        ok = true;
    }
    free(slot);
    return ok;
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
    no_memory(err);
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

double glint_pipeline_value(const struct glint_pipeline *pipeline, const struct glint_pass *pass,
                            const struct glint_row *parameter) {
    const struct pipeline_pass *entry = pipeline_find(pipeline, pass->slot);
    if (!entry || entry->pass != pass || parameter < pass->rows || parameter >= pass->rows + pass->row_count) return 0;
    return entry->values[parameter - pass->rows];
}

static const double *value_of(const struct pipeline_pass *entry, const char *parameter) {
    for (size_t r = 0; r < entry->pass->row_count; r++)
        if (row_is_parameter(&entry->pass->rows[r]) && strcmp(entry->pass->rows[r].name, parameter) == 0)
            return &entry->values[r];
    return NULL;
}

void pipeline_classes(const struct glint_pipeline *pipeline, float *smooth, float *rough) {
    *smooth = -1, *rough = INFINITY;
    for (size_t p = 0; p < pipeline->count; p++) {
        const struct glint_pass *pass = pipeline->passes[p].pass;
        for (size_t r = 0; r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            const double *limit =
                row->kind == GLINT_ROW_DISPATCH_TILES && row->image ? value_of(&pipeline->passes[p], row->image) : NULL;
            if (limit && strcmp(row->name, "smooth") == 0) *smooth = fmaxf(*smooth, (float)*limit);
            if (limit && strcmp(row->name, "rough") == 0) *rough = fminf(*rough, (float)*limit);
        }
    }
}

bool pipeline_shows_all(const struct glint_pipeline *pipeline) {
    for (size_t p = 0; p < pipeline->count; p++) {
        const struct glint_row *row = pass_row(pipeline->passes[p].pass, GLINT_ROW_ALL_VISIBLE_UNLESS, NULL);
        const double *value = row ? value_of(&pipeline->passes[p], row->name) : NULL;
        if (value && *value == 0) return true;
    }
    return false;
}
