/* The table's entries are what glint view shows for their light. */
#include "edit/lut.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static float light_of(const struct lut_options *o, uint32_t entry) {
    const double t = (double)entry / (o->size - 1);
    return (float)(exp2(o->stops[0] + (o->stops[1] - o->stops[0]) * t) - exp2(o->stops[0]));
}

/* The three channels, beside each other, in place of RGBA. */
static void without_alpha(float *values, size_t count) {
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++) {
            const float v = values[4 * i + k];
            values[3 * i + k] = v > 0 ? v < 1 ? v : 1 : 0;
        }
}

bool lut_add(struct glint_edit *edit, const struct lut_options *o, struct glint_error *err) {
    static const char *const channels[] = {"R", "G", "B"};
    const size_t n = o->size, count = n * n * n, old = glint_edit_find(edit, "lut");
    char stops[64];
    float *values = malloc(count * 4 * sizeof *values);
    if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the table of colours");
    for (size_t i = 0; i < count; i++) {
        const size_t entry[] = {i % n, i / n % n, i / n / n};
        for (size_t k = 0; k < 3; k++) values[4 * i + k] = light_of(o, (uint32_t)entry[k]);
        values[4 * i + 3] = 1;
    }
    bool ok = ocio_apply(&o->ocio, values, n, n * n, err);
    if (ok) {
        without_alpha(values, count);
        if (glint_edit_part(edit, old)) glint_edit_drop_part(edit, old);
        ok = glint_edit_add_part(edit, "lut", o->size, o->size * o->size, channels, 3, values, err);
    }
    free(values);
    snprintf(stops, sizeof stops, "%.17g,%.17g", o->stops[0], o->stops[1]);
    return ok && glint_edit_assign(edit, "gbuffer", "lutStops", stops, err);
}
