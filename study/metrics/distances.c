/* Errors of distances by class of pixel. */
#include "distances.h"

#include <math.h>
#include <stdlib.h>

#include "glint/metrics.h"
#include "glint/sort.h"

double distance_relative_error(double found, double truth) {
    if (!(found >= 0)) return INFINITY;
    if (isinf(found) || isinf(truth)) return isinf(found) && isinf(truth) ? 0 : INFINITY;
    return fabs(found - truth) / truth;
}

/* `values` is scratch memory for `count` values; label 0 means all. */
static struct glint_distance_error distance_error(const float *found, const float *truth, const uint8_t *labels,
                                                  size_t count, uint8_t label, double *values) {
    struct glint_distance_error e = {0};
    size_t n = 0, right = 0;
    for (size_t i = 0; i < count; i++) {
        if (!(truth[i] > 0) || labels[i] == GLINT_CLASS_NONE || (label && labels[i] != label)) continue;
        values[n] = distance_relative_error((double)found[i], (double)truth[i]);
        right += values[n++] <= 0.05;
        e.invalid += !(found[i] >= 0);
    }
    e.rays = n;
    if (n == 0) return e;
    glint_sort_doubles(values, n);
    e.right = (double)right / (double)n;
    e.median = values[n / 2];
    e.p95 = values[n * 95 / 100];
    return e;
}

bool glint_study_distances(const float *found, const float *truth, const uint8_t *labels, size_t count,
                           struct glint_distance_errors *errors, struct glint_error *err) {
    double *values = malloc((count + 1) * sizeof *values);
    *errors = (struct glint_distance_errors){0};
    if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "distances to compare: out of memory");
    for (uint8_t k = 0; k < GLINT_CLASS_COUNT; k++)
        errors->of[k] = distance_error(found, truth, labels, count, k, values);
    free(values);
    return true;
}
