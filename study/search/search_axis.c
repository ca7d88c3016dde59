/* Measures axes in steps, such that a step of any axis is a noticeable change. */
#include "search.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINEAR_STEPS = 8 };

enum glint_search_scale glint_search_scale(double lowest, double highest, double start) {
    const double from = lowest > 0 ? lowest : start > 0 ? start : 1;
    return lowest >= 0 && highest > 16 * from ? GLINT_SEARCH_DOUBLING : GLINT_SEARCH_LINEAR;
}

/* The smallest value that is doubled. If the range begins at 0, it is a quarter of the start, so that 0 is about two steps away. */
static double doubling_base(const struct glint_search_axis *axis) {
    if (axis->lowest > 0) return axis->lowest;
    if (axis->start > 0) return axis->start / 4;
    return fmin(axis->highest, 1) / 100;
}
/* Added to a value before it is doubled, so that 0 can be reached. */
static double doubling_offset(const struct glint_search_axis *axis) {
    return axis->lowest > 0 ? 0 : doubling_base(axis);
}

double axis_steps(const struct glint_search_axis *axis, double value) {
    if (axis->choices) return value;
    if (axis->scale == GLINT_SEARCH_LINEAR)
        return axis->highest > axis->lowest ? LINEAR_STEPS * (value - axis->lowest) / (axis->highest - axis->lowest)
                                            : 0;
    return log2((value + doubling_offset(axis)) / doubling_base(axis));
}

double axis_length(const struct glint_search_axis *axis) {
    return axis->choices ? axis->choices - 1 : axis_steps(axis, axis->highest);
}

double axis_value_at(const struct glint_search_axis *axis, double steps) {
    double value;
    if (axis->choices) return round(fmin(fmax(steps, 0), axis->choices - 1));
    if (fabs(steps - axis_steps(axis, axis->start)) < 1e-9) return axis->start;
    if (axis->scale == GLINT_SEARCH_LINEAR)
        value = axis->lowest + steps * (axis->highest - axis->lowest) / LINEAR_STEPS;
    else value = doubling_base(axis) * exp2(steps) - doubling_offset(axis);
    if (axis->whole) value = round(value);
    else { /* rounded to four digits for readability */ char text[32];
        snprintf(text, sizeof text, "%.4g", value);
        value = strtod(text, NULL);
    }
    return fmin(fmax(value, axis->lowest), axis->highest);
}

double axis_move(const struct glint_search_axis *axis, double from, double step) {
    const double length = axis_length(axis), here = axis_value_at(axis, from);
    double to = fmin(fmax(from + step, 0), length), value = axis_value_at(axis, to);
    if (value == here && axis->whole && !axis->choices) {
        value = fmin(fmax(here + (step > 0 ? 1 : -1), axis->lowest), axis->highest);
        to = axis_steps(axis, value);
    }
    return value == here ? NAN : to;
}
