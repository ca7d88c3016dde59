/* Values in ascending order, and what stands in their middle. Beside the library, not of it: not installed. */
#ifndef GLINT_SORT_H
#define GLINT_SORT_H

#include <math.h>
#include <stdlib.h>

static inline int glint_compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}
static inline int glint_compare_floats(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static inline void glint_sort_doubles(double *values, size_t count) {
    if (count) qsort(values, count, sizeof *values, glint_compare_doubles);
}
static inline void glint_sort_floats(float *values, size_t count) {
    if (count) qsort(values, count, sizeof *values, glint_compare_floats);
}

/* Sorts; the mean of the middle two of an even number, NaN of none. */
static inline double glint_median(double *values, size_t count) {
    glint_sort_doubles(values, count);
    return count ? (values[(count - 1) / 2] + values[count / 2]) / 2 : (double)NAN;
}

#endif
