/* Parses axes: names, and the values of a list or a range. */
#include "axis.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whether it is a parameter of the pipeline itself, which no pass declares. */
static bool is_pipeline_parameter(const char *name) {
    return strncmp(name, "pipeline.", 9) == 0;
}

/* The row of slot.parameter in the pipeline, or NULL. */
static const struct glint_row *find_row(const struct glint_pipeline *pipeline, const char *name) {
    const struct glint_pass *pass;
    return glint_pipeline_parameter(pipeline, name, &pass, NULL);
}

bool axis_applies(const struct axis *axis, const struct glint_pipeline *pipeline) {
    for (size_t i = 0; i < axis->name_count; i++)
        if (axis->variant || is_pipeline_parameter(axis->names[i]) || find_row(pipeline, axis->names[i])) return true;
    return false;
}

bool axis_assign(const struct axis *axis, struct glint_pipeline *pipeline, const char *value, struct glint_error *err) {
    char assignment[384];
    struct glint_error own = {0};
    bool ok = true;
    for (size_t i = 0; ok && i < axis->name_count; i++) {
        if (!axis->variant && !is_pipeline_parameter(axis->names[i]) && !find_row(pipeline, axis->names[i])) continue;
        snprintf(assignment, sizeof assignment, "%s=%s", axis->names[i], value);
        ok = axis->variant ? glint_pipeline_use(pipeline, assignment, &own)
                           : glint_pipeline_set(pipeline, assignment, &own);
    }
    return ok || glint_fail(err, own.code, "--vary %s: %s", axis->text, own.message);
}

bool axis_read_names(struct axis *axis, const char *text, struct glint_error *err) {
    const char *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : 0;
    *axis = (struct axis){0};
    if (!length || !equals[1] || length >= sizeof axis->text)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "--vary: expected SLOT.PARAMETER=A..B, a list A,B or SLOT=VARIANT,VARIANT, found '%s'", text);
    memcpy(axis->text, text, length);
    memcpy(axis->pieces, text, length);
    for (char *piece = axis->pieces, *next; piece; piece = next) {
        if ((next = strchr(piece, '+'))) *next++ = 0;
        const bool variant = !strchr(piece, '.');
        if (axis->name_count == AXIS_NAMES || !*piece || (axis->name_count && variant != axis->variant))
            return glint_fail(err, GLINT_ERROR_USAGE,
                              "--vary %s: expected up to %d parameters, or slots, with + between them", axis->text,
                              AXIS_NAMES);
        axis->variant = variant;
        axis->names[axis->name_count++] = piece;
    }
    return true;
}

void axis_finish(struct axis *axis) {
    free(axis->values);
    axis->values = NULL;
    axis->count = 0;
}

static bool add_value(struct axis *axis, const char *value, struct glint_error *err) {
    for (size_t i = 0; i < axis->count; i++)
        if (!strcmp(axis->values[i], value)) return true; /* rounding to whole numbers may repeat values */
    if (axis->count == AXIS_VALUES)
        return glint_fail(err, GLINT_ERROR_LIMIT, "--vary %s: expected at most %d values", axis->text, AXIS_VALUES);
    if ((axis->count & (axis->count + 1)) == 0) { /* 0, 1, 3, 7, …: the array is full */
        void *larger = realloc(axis->values, 2 * (axis->count + 1) * sizeof *axis->values);
        if (!larger) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        axis->values = larger;
    }
    snprintf(axis->values[axis->count++], VALUE_SIZE, "%s", value);
    return true;
}

static bool add_number(struct axis *axis, double number, struct glint_error *err) {
    char text[VALUE_SIZE];
    snprintf(text, sizeof text, "%.7g", axis->whole ? round(number) : number);
    return add_value(axis, text, err);
}

static bool read_list(struct axis *axis, const char *text, struct glint_error *err) {
    for (const char *at = text; at; at = *at ? at + 1 : NULL) {
        char value[VALUE_SIZE];
        const size_t length = strcspn(at, ",");
        if (length == 0 || length >= sizeof value)
            return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s: expected values with commas between them, found '%s'",
                              axis->text, text);
        snprintf(value, sizeof value, "%.*s", (int)length, at);
        if (!add_value(axis, value, err)) return false;
        at += length;
        if (!*at) return true;
    }
    return true;
}

/* `count` values with equal ratios, or doublings if `count` is 0. */
static bool add_ratios(struct axis *axis, size_t count, struct glint_error *err) {
    const double low = axis->low, high = axis->high;
    if (!(low > 0))
        return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s: a range by ratios begins above 0, found %g", axis->text,
                          low);
    axis->log = true;
    for (size_t i = 0; count && i < count; i++)
        if (!add_number(axis, low * pow(high / low, count > 1 ? (double)i / (double)(count - 1) : 0), err))
            return false;
    for (double value = low; !count && value < high; value *= 2)
        if (!add_number(axis, value, err)) return false;
    return count || add_number(axis, high, err);
}

static bool add_steps(struct axis *axis, double step, struct glint_error *err) {
    const double many = floor((axis->high - axis->low) / step * (1 + 1e-9));
    if (!(many < AXIS_VALUES))
        return glint_fail(err, GLINT_ERROR_LIMIT, "--vary %s: expected at most %d values, found %.0f", axis->text,
                          AXIS_VALUES, many + 1);
    for (double i = 0; i <= many; i++)
        if (!add_number(axis, axis->low + i * step, err)) return false;
    return true;
}

static bool read_range(struct axis *axis, const char *text, struct glint_error *err) {
    char low[VALUE_SIZE], *end, *rest;
    const char *dots =
        strstr(text, ".."); /* the lower end is copied, since strtod would parse "4." of "4..8" as a number */
    axis->range = true;
    snprintf(low, sizeof low, "%.*s", (int)(dots - text), text);
    axis->low = strtod(low, &end);
    axis->high = strtod(dots + 2, &rest);
    const bool ok = end != low && !*end && rest != dots + 2 && (!*rest || *rest == ':') && isfinite(axis->low) &&
                    isfinite(axis->high);
    if (!ok)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "--vary %s: expected A..B, A..B:STEP, A..B:log or A..B:logN, found '%s'", axis->text, text);
    if (!(axis->low < axis->high))
        return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s: expected a range that rises, found %g to %g", axis->text,
                          axis->low, axis->high);
    if (axis->whole && (axis->low != floor(axis->low) || axis->high != floor(axis->high)))
        return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s: expected whole numbers, found %g to %g", axis->text,
                          axis->low, axis->high);
    if (!*rest) return add_steps(axis, axis->whole ? 1 : (axis->high - axis->low) / 4, err);
    if (!strcmp(rest, ":log")) return add_ratios(axis, 0, err);
    const bool ratios = !strncmp(rest, ":log", 4);
    const char *suffix = rest + (ratios ? 4 : 1);
    const double number = strtod(suffix, &end);
    if (end == suffix || *end || !(number > 0) ||
        (ratios && !(number >= 2 && number <= AXIS_VALUES && number == floor(number))))
        return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s: expected %s after A..B, found '%s'", axis->text,
                          ratios ? ":log or :logN with N from 2" : ":STEP above 0 or :log", rest);
    return ratios ? add_ratios(axis, (size_t)number, err) : add_steps(axis, number, err);
}

/* Finds in the declarations what kind of values the axis takes. */
static bool read_kind(struct axis *axis, const struct glint_pipeline *const *pipelines, size_t count, bool range,
                      struct glint_error *err) {
    for (size_t n = 0; n < axis->name_count; n++) {
        const struct glint_row *row = NULL;
        for (size_t p = 0; p < count && !row; p++) row = find_row(pipelines[p], axis->names[n]);
        axis->whole |= is_pipeline_parameter(axis->names[n]) || (row && row->type != GLINT_VALUE_FLOAT);
        if (!row && !is_pipeline_parameter(axis->names[n])) {
            const struct glint_pass *pass;
            struct glint_error own = {0};
            glint_pipeline_parameter(pipelines[0], axis->names[n], &pass, &own);
            return glint_fail(err, own.code, "--vary %s: %s", axis->text, own.message);
        }
        if (row && row->choices && range)
            return glint_fail(err, GLINT_ERROR_USAGE,
                              "--vary %s: expected a list of choices such as %s,%s, found a range", axis->text,
                              row->choices[0], row->choices[1] ? row->choices[1] : row->choices[0]);
    }
    return true;
}

bool axis_init(struct axis *axis, const char *text, const struct glint_pipeline *const *pipelines, size_t count,
               struct glint_error *err) {
    if (!axis_read_names(axis, text, err)) return false;
    const char *values = strchr(text, '=') + 1;
    const bool range = !axis->variant && strstr(values, "..");
    return (axis->variant || read_kind(axis, pipelines, count, range, err)) &&
           (range ? read_range(axis, values, err) : read_list(axis, values, err));
}

void axis_value(const struct axis *axis, double at, char value[VALUE_SIZE]) {
    if (!axis->range) {
        const size_t i = (size_t)(at * (double)axis->count);
        snprintf(value, VALUE_SIZE, "%s", axis->values[i < axis->count ? i : axis->count - 1]);
        return;
    }
    double number;
    if (axis->log) number = axis->low * pow(axis->high / axis->low, at);
    else if (axis->whole) number = axis->low + floor(at * (axis->high - axis->low + 1)); /* with equal probability */
    else number = axis->low + at * (axis->high - axis->low);
    if (axis->whole) number = round(number);
    snprintf(value, VALUE_SIZE, "%.7g", number > axis->high ? axis->high : number);
}
