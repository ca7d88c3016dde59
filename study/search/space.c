/* The points of a space: grids, Latin hypercubes, and their order. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "axis.h"
#include "no_memory.h"
#include "random.h"

enum { POINTS = 100000 };

struct glint_space {
    struct glint_pipeline *base;
    struct axis *axes;
    size_t axis_count;
    char (*values)[VALUE_SIZE]; /* axis_count a point */
    size_t count;
};

void glint_space_destroy(struct glint_space **pointer) {
    struct glint_space *space = *pointer;
    *pointer = NULL;
    if (!space) return;
    for (size_t a = 0; space->axes && a < space->axis_count; a++) axis_finish(&space->axes[a]);
    free(space->axes);
    free(space->values);
    if (space->base) glint_pipeline_destroy(&space->base);
    free(space);
}

/* Creates a pipeline for each variant that an axis chooses, so that the parameters of all variants are known. */
static bool list_variants(const struct glint_space *space, struct glint_pipeline **pipelines, size_t *count,
                          struct glint_error *err) {
    if (!(pipelines[(*count)++] = glint_pipeline_copy(space->base, err))) return false;
    for (size_t a = 0; a < space->axis_count; a++)
        for (size_t i = 0; space->axes[a].variant && i < space->axes[a].count; i++)
            if (!(pipelines[*count] = glint_pipeline_copy(space->base, err)) ||
                !axis_assign(&space->axes[a], pipelines[(*count)++], space->axes[a].values[i], err))
                return false;
    return true;
}

static bool init_axes(struct glint_space *space, const char *const *axes, bool variants,
                      const struct glint_pipeline *const *pipelines, size_t count, struct glint_error *err) {
    for (size_t a = 0; a < space->axis_count; a++) {
        struct axis *axis = &space->axes[a];
        struct axis probe;
        if (!axis_read_names(&probe, axes[a], err)) return false;
        if (probe.variant != variants) continue;
        if (!axis_init(axis, axes[a], pipelines, count, err)) return false;
        for (size_t b = 0; b < a; b++)
            if (space->axes[b].count && !strcmp(space->axes[b].text, axis->text))
                return glint_fail(err, GLINT_ERROR_USAGE, "--vary %s: varied twice", axis->text);
    }
    return true;
}

static struct glint_space *create_space(const struct glint_pipeline *base, const char *const *axes,
                                        struct glint_error *err) {
    struct glint_space *space = calloc(1, sizeof *space);
    struct glint_pipeline **pipelines = NULL;
    size_t count = 0, variants = 1;
    bool ok = space != NULL || no_memory(err, "parameter space");
    while (ok && axes[space->axis_count]) space->axis_count++;
    if (ok && !space->axis_count) ok = glint_fail(err, GLINT_ERROR_USAGE, "expected an axis to vary");
    ok = ok && ((space->axes = calloc(space->axis_count, sizeof *space->axes)) || no_memory(err, "parameter space")) &&
         (space->base = glint_pipeline_copy(base, err)) && init_axes(space, axes, true, NULL, 0, err);
    for (size_t a = 0; ok && a < space->axis_count; a++) variants += space->axes[a].count;
    ok = ok && ((pipelines = calloc(variants, sizeof *pipelines)) || no_memory(err, "parameter space")) &&
         list_variants(space, pipelines, &count, err) &&
         init_axes(space, axes, false, (const struct glint_pipeline *const *)pipelines, count, err);
    for (size_t i = 0; pipelines && i < variants; i++)
        if (pipelines[i]) glint_pipeline_destroy(&pipelines[i]);
    free(pipelines);
    if (!ok && space) glint_space_destroy(&space);
    return space;
}

static char *value_at(const struct glint_space *space, size_t point, size_t axis) {
    return space->values[point * space->axis_count + axis];
}

/* The base pipeline with the point's variants and then its values. Values without a parameter in that pipeline become "". */
static struct glint_pipeline *build_pipeline(const struct glint_space *space, size_t point, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_copy(space->base, err);
    bool ok = pipeline != NULL;
    for (int variants = 1; variants >= 0; variants--)
        for (size_t a = 0; ok && a < space->axis_count; a++) {
            char *value = value_at(space, point, a);
            if (space->axes[a].variant != (variants == 1)) continue;
            if (!axis_applies(&space->axes[a], pipeline)) value[0] = 0;
            ok = !value[0] || axis_assign(&space->axes[a], pipeline, value, err);
        }
    if (!ok && pipeline) glint_pipeline_destroy(&pipeline);
    return pipeline;
}

/* Adds a point whose values are all "". */
static bool add_point(struct glint_space *space, struct glint_error *err) {
    if (space->count == POINTS)
        return glint_fail(err, GLINT_ERROR_LIMIT, "expected at most %d points; fewer values, or a sample", POINTS);
    void *larger = realloc(space->values, (space->count + 1) * space->axis_count * sizeof *space->values);
    if (!larger) return no_memory(err, "parameter space");
    space->values = larger;
    memset(value_at(space, space->count++, 0), 0, space->axis_count * sizeof *space->values);
    return true;
}

/* Adds point `number` of the grid, unless it repeats another point since it has no parameter for one of its values. */
static bool add_grid_point(struct glint_space *space, size_t number, struct glint_error *err) {
    if (!add_point(space, err)) return false;
    const size_t point = space->count - 1;
    size_t rest = number;
    for (size_t a = space->axis_count; a-- > 0; rest /= space->axes[a].count)
        memcpy(value_at(space, point, a), space->axes[a].values[rest % space->axes[a].count], VALUE_SIZE);
    struct glint_pipeline *pipeline = build_pipeline(space, point, err);
    if (!pipeline) return false;
    glint_pipeline_destroy(&pipeline);
    bool repeats = false;
    rest = number;
    for (size_t a = space->axis_count; a-- > 0; rest /= space->axes[a].count)
        repeats |= rest % space->axes[a].count && !value_at(space, point, a)[0];
    space->count -= repeats;
    return true;
}

struct glint_space *glint_space_create(const struct glint_pipeline *base, const char *const *axes,
                                       struct glint_error *err) {
    struct glint_space *space = create_space(base, axes, err);
    double points = 1;
    for (size_t a = 0; space && a < space->axis_count; a++) points *= (double)space->axes[a].count;
    bool ok = space != NULL;
    if (ok && points > POINTS)
        ok = glint_fail(err, GLINT_ERROR_LIMIT,
                        "expected at most %d points, found a grid of %.0f; fewer values, or a sample", POINTS, points);
    for (size_t i = 0; ok && (double)i < points; i++) ok = add_grid_point(space, i, err);
    if (!ok && space) glint_space_destroy(&space);
    return space;
}

struct glint_space *glint_space_create_hypercube(const struct glint_pipeline *base, const char *const *axes,
                                                 uint32_t count, uint64_t seed, struct glint_error *err) {
    if (count == 0 || count > POINTS) {
        glint_fail(err, GLINT_ERROR_USAGE, "a Latin hypercube: expected 1 to %d points, found %u", POINTS, count);
        return NULL;
    }
    struct glint_space *space = create_space(base, axes, err);
    uint32_t *strata = calloc(count, sizeof *strata);
    bool ok = space && (strata || no_memory(err, "parameter space"));
    for (uint32_t i = 0; ok && i < count; i++) ok = add_point(space, err);
    for (size_t a = 0; ok && a < space->axis_count; a++) {
        for (uint32_t i = 0; i < count; i++) { /* Fisher and Yates */
            const uint32_t j = (uint32_t)(next_unit(&seed) * (i + 1));
            strata[i] = strata[j];
            strata[j] = i;
        }
        for (uint32_t i = 0; i < count; i++)
            axis_value(&space->axes[a], (strata[i] + next_unit(&seed)) / count, value_at(space, i, a));
    }
    for (uint32_t i = 0; ok && i < count; i++) {
        struct glint_pipeline *pipeline = build_pipeline(space, i, err);
        ok = pipeline != NULL;
        if (ok) glint_pipeline_destroy(&pipeline);
    }
    free(strata);
    if (!ok && space) glint_space_destroy(&space);
    return space;
}

size_t glint_space_axis_count(const struct glint_space *space) {
    return space->axis_count;
}
const char *glint_space_axis(const struct glint_space *space, size_t axis) {
    return space->axes[axis].text;
}
size_t glint_space_count(const struct glint_space *space) {
    return space->count;
}
const char *glint_space_value(const struct glint_space *space, size_t point, size_t axis) {
    return value_at(space, point, axis);
}
struct glint_pipeline *glint_space_pipeline(const struct glint_space *space, size_t point, struct glint_error *err) {
    return build_pipeline(space, point, err);
}

/* The index of the first slot that the axis changes, from 1; 0 if it is none of the list. */
static size_t first_slot_index(const struct axis *axis, const char *const *slots) {
    size_t earliest = SIZE_MAX;
    for (size_t n = 0; n < axis->name_count; n++) {
        const size_t length = strcspn(axis->names[n], ".");
        size_t place = 0;
        while (slots[place] && (strlen(slots[place]) != length || strncmp(slots[place], axis->names[n], length) != 0))
            place++;
        place = slots[place] ? place + 1 : 0;
        if (place < earliest) earliest = place;
    }
    return earliest;
}

/* The sort key of a value: its index in a list, or the number itself in a range. */
static double sort_value(const struct axis *axis, const char *value) {
    if (axis->range || !value[0]) return value[0] ? strtod(value, NULL) : -HUGE_VAL;
    size_t i = 0;
    while (i < axis->count && strcmp(axis->values[i], value) != 0) i++;
    return (double)i;
}

/* A point with its sort keys, those of the axis with the earliest slot first. */
struct sorting {
    size_t point, axes;
    double *ranks;
};

static int compare_points(const void *a, const void *b) {
    const struct sorting *x = a, *y = b;
    for (size_t i = 0; i < x->axes; i++)
        if (x->ranks[i] != y->ranks[i]) return x->ranks[i] < y->ranks[i] ? -1 : 1;
    return (x->point > y->point) - (x->point < y->point);
}

static void order_axes(const struct glint_space *space, const char *const *slots, size_t *order) {
    for (size_t a = 0; a < space->axis_count; a++) {
        const size_t place = first_slot_index(&space->axes[a], slots);
        size_t i = a;
        for (; i > 0 && first_slot_index(&space->axes[order[i - 1]], slots) > place; i--) order[i] = order[i - 1];
        order[i] = a;
    }
}

bool glint_space_sort(struct glint_space *space, const char *const *slots, struct glint_error *err) {
    const size_t axes = space->axis_count;
    struct sorting *sorting = calloc(space->count + 1, sizeof *sorting);
    double *ranks = calloc(space->count * axes + 1, sizeof *ranks);
    size_t *order = calloc(axes + 1, sizeof *order);
    char(*values)[VALUE_SIZE] = calloc(space->count * axes + 1, sizeof *values);
    const bool ok = (sorting && ranks && order && values) || no_memory(err, "parameter space");
    if (ok) order_axes(space, slots, order);
    for (size_t i = 0; ok && i < space->count; i++) {
        sorting[i] = (struct sorting){i, axes, ranks + i * axes};
        for (size_t a = 0; a < axes; a++)
            ranks[i * axes + a] = sort_value(&space->axes[order[a]], value_at(space, i, order[a]));
    }
    if (ok) qsort(sorting, space->count, sizeof *sorting, compare_points);
    for (size_t i = 0; ok && i < space->count; i++)
        memcpy(values[i * axes], value_at(space, sorting[i].point, 0), axes * sizeof *values);
    if (ok) memcpy(space->values, values, space->count * axes * sizeof *values);
    free(values);
    free(order);
    free(ranks);
    free(sorting);
    return ok;
}
