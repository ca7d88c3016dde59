/* Pareto fronts. */
#include <math.h>
#include <stdlib.h>

#include "glint/space.h"

struct place {
    double x, y;
    size_t point;
};

static int by_x_then_y(const void *a, const void *b) {
    const struct place *p = a, *q = b;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    if (p->y != q->y) return p->y < q->y ? -1 : 1;
    return (p->point > q->point) - (p->point < q->point);
}

bool glint_pareto(const double *x, const double *y, size_t count, bool *on, struct glint_error *err) {
    struct place *places = calloc(count + 1, sizeof *places);
    if (!places) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    size_t valid = 0;
    for (size_t i = 0; i < count; i++) {
        on[i] = false;
        if (!isnan(x[i]) && !isnan(y[i])) places[valid++] = (struct place){x[i], y[i], i};
    }
    qsort(places, valid, sizeof *places, by_x_then_y);
    double lowest = 0; /* y of the points before, which dominate or equal every point that is not lower */
    for (size_t i = 0; i < valid; i++) {
        if (i > 0 && !(places[i].y < lowest)) continue;
        on[places[i].point] = true;
        lowest = places[i].y;
    }
    free(places);
    return true;
}
