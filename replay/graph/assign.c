/* Parses and checks assignments to a pipeline, as --set, --use and --shader pass them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "faults.h"
#include "nearest.h"
#include "pipeline.h"
#include "row.h"

bool glint_pipeline_set_value(struct glint_pipeline *pipeline, const struct glint_pass *pass,
                              const struct glint_row *row, double value, struct glint_error *err) {
    const struct pipeline_pass *entry = pipeline_find(pipeline, pass->slot);
    if (!entry || entry->pass != pass)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s/%s is not part of the pipeline %s", pass->slot, pass->variant,
                          pipeline->name);
    const bool within = value >= row->lowest && value <= row->highest;
    if (!within || (row->type != GLINT_VALUE_FLOAT && value != floor(value)))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s.%s: expected %s%.9g to %.9g (%s), found %.9g", pass->slot,
                          row->name, within ? "a whole number from " : "", row->lowest, row->highest, row->unit, value);
    entry->values[row - pass->rows] = value + 0.0; /* which makes 0 of -0: equal values are one value */
    return true;
}

/* Parses the text of a parameter's value without checking its range. */
static bool parse_value(const char *slot, const struct glint_row *row, const char *text, double *value,
                        struct glint_error *err) {
    char known[512] = "", *end;
    for (size_t c = 0; row->choices && row->choices[c]; c++) {
        *value = (double)c;
        if (strcmp(row->choices[c], text) == 0) return true;
        text_list(known, sizeof known, row->choices[c]);
    }
    if (row->choices)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s.%s: expected one of %s, found '%s'", slot, row->name, known,
                          text);
    const bool flag = row->type == GLINT_VALUE_BOOL;
    const bool on = flag && (strcmp(text, "true") == 0 || strcmp(text, "on") == 0),
               off = flag && (strcmp(text, "false") == 0 || strcmp(text, "off") == 0);
    *value = on || off ? on : strtod(text, &end);
    if (on || off || (end != text && !*end)) return true;
    return glint_fail(err, GLINT_ERROR_USAGE, "%s.%s: expected %s from %.9g to %.9g (%s), found '%s'", slot, row->name,
                      flag ? "true, false or a number" : "a number", row->lowest, row->highest, row->unit, text);
}

static bool set_text(struct glint_pipeline *pipeline, const struct glint_pass *pass, const struct glint_row *row,
                     const char *text, struct glint_error *err) {
    double value = 0;
    return parse_value(pass->slot, row, text, &value, err) && glint_pipeline_set_value(pipeline, pass, row, value, err);
}

static bool not_in_pipeline(const struct glint_pipeline *pipeline, const char *slot, struct glint_error *err) {
    return glint_slot_check(slot, err) &&
           glint_fail(err, GLINT_ERROR_USAGE, "slot %s is not part of the pipeline %s", slot, pipeline->name);
}

const struct glint_row *glint_pipeline_parameter(const struct glint_pipeline *pipeline, const char *name,
                                                 const struct glint_pass **pass, struct glint_error *err) {
    const char *dot = strchr(name, '.'), *parameter = dot ? dot + 1 : "";
    char slot[64];
    snprintf(slot, sizeof slot, "%.*s", dot ? (int)(dot - name) : 0, name);
    *pass = glint_pipeline_find(pipeline, slot);
    if (!slot[0] || !parameter[0]) {
        glint_fail(err, GLINT_ERROR_USAGE, "expected SLOT.PARAMETER, found '%s'", name);
        return NULL;
    }
    if (!*pass) {
        not_in_pipeline(pipeline, slot, err);
        return NULL;
    }
    const struct glint_row *row = glint_pass_parameter(*pass, parameter);
    struct glint_nearest near = glint_nearest_to(parameter);
    for (size_t r = 0; !row && r < (*pass)->row_count; r++)
        if (glint_row_is_parameter(&(*pass)->rows[r])) glint_nearest_offer(&near, (*pass)->rows[r].name);
    if (!row)
        glint_fail(err, GLINT_ERROR_USAGE, "%s/%s has no parameter %s%s", slot, (*pass)->variant, parameter,
                   glint_nearest_or_known(&near));
    return row;
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

/* pipeline.rays and pipeline.first_ray belong to the pipeline itself. Any other parameter is set in each pass that has it. It is no error if
   no pass of this pipeline has it, so that a switch can be turned off for all presets alike. */
static bool set_everywhere(struct glint_pipeline *pipeline, const char *parameter, const char *text,
                           struct glint_error *err) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    bool known = false;
    struct glint_nearest near = glint_nearest_to(parameter);
    if (!strcmp(parameter, "rays") || !strcmp(parameter, "first_ray")) return set_rays(pipeline, parameter, text, err);
    glint_nearest_offer(&near, "rays");
    glint_nearest_offer(&near, "first_ray");
    for (size_t i = 0; i < count && !known; i++) {
        known = glint_pass_parameter(&all[i], parameter) != NULL;
        for (size_t r = 0; r < all[i].row_count; r++)
            if (glint_row_is_parameter(&all[i].rows[r])) glint_nearest_offer(&near, all[i].rows[r].name);
    }
    if (!known)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "pipeline has no parameter '%s'%s; known: rays, first_ray, and those that any pass has",
                          parameter, glint_nearest_text(&near));
    for (size_t i = 0; i < pipeline->count; i++) {
        const struct glint_pass *pass = pipeline->passes[i].pass;
        const struct glint_row *row = glint_pass_parameter(pass, parameter);
        if (row && !set_text(pipeline, pass, row, text, err)) return false;
    }
    return true;
}

/* Splits "left=right" into a copy of the left side, which the caller frees, and the right side. */
static char *split_assignment(const char *assignment, const char *form, const char **right, struct glint_error *err) {
    const char *equals = strchr(assignment, '=');
    char *left = NULL;
    if (!equals || equals == assignment || !equals[1])
        glint_fail(err, GLINT_ERROR_USAGE, "expected %s, found '%s'", form, assignment);
    else if (!(left = strndup(assignment, (size_t)(equals - assignment))))
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else *right = equals + 1;
    return left;
}

bool glint_pipeline_use(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err) {
    const char *variant;
    char *slot = split_assignment(assignment, "SLOT=VARIANT", &variant, err);
    bool ok = slot && pipeline_use(pipeline, slot, variant, err);
    free(slot);
    return ok;
}

bool glint_pipeline_set(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err) {
    static const char everywhere[] = "pipeline.";
    const char *value;
    const struct glint_pass *pass = NULL;
    char *name = split_assignment(assignment, "SLOT.PARAMETER=VALUE", &value, err);
    const bool all = name && strncmp(name, everywhere, sizeof everywhere - 1) == 0;
    const struct glint_row *row = name && !all ? glint_pipeline_parameter(pipeline, name, &pass, err) : NULL;
    bool ok = all   ? set_everywhere(pipeline, name + sizeof everywhere - 1, value, err)
              : row ? set_text(pipeline, pass, row, value, err)
                    : false;
    free(name);
    return ok;
}

bool glint_pipeline_shader(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err) {
    const char *path;
    char *slot = split_assignment(assignment, "SLOT=FILE", &path, err), *copy = NULL;
    struct pipeline_pass *entry = slot ? (struct pipeline_pass *)pipeline_find(pipeline, slot) : NULL;
    bool ok = false;
    if (!slot) return false;
    if (!entry) not_in_pipeline(pipeline, slot, err);
    else if (entry->pass->host)
        glint_fail(err, GLINT_ERROR_USAGE, "%s/%s runs on the host and has no shader to replace", slot,
                   entry->pass->variant);
    else if (!(copy = strdup(path))) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else {
        free(entry->shader);
        entry->shader = copy;
        ok = true;
    }
    free(slot);
    return ok;
}
