/* Axes in steps, so that one step of any of them is worth a look. */
#include "search.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINEAR_STEPS = 8 };

enum glint_search_scale glint_search_scale(double lowest, double highest, double start) {
    const double from = lowest > 0 ? lowest : start > 0 ? start : 1;
    return lowest >= 0 && highest > 16 * from ? GLINT_SEARCH_DOUBLING : GLINT_SEARCH_LINEAR;
}

/* Added to what is above the lowest value before it is doubled: a fourth of the start, so that zero is two steps away. */
static double ground(const struct glint_search_axis *axis) {
    if (axis->lowest > 0) return axis->lowest;
    if (axis->start > 0) return axis->start / 4;
    return fmin(axis->highest, 1) / 100;
}
/* What is doubled begins there, where a step begins at the lowest value. */
static double offset(const struct glint_search_axis *axis) {
    return axis->lowest > 0 ? 0 : ground(axis);
}

double axis_steps(const struct glint_search_axis *axis, double value) {
    if (axis->choices) return value;
    if (axis->scale == GLINT_SEARCH_LINEAR)
        return axis->highest > axis->lowest ? LINEAR_STEPS * (value - axis->lowest) / (axis->highest - axis->lowest)
                                            : 0;
    return log2((value + offset(axis)) / ground(axis));
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
    else value = ground(axis) * exp2(steps) - offset(axis);
    if (axis->whole) value = round(value);
    else { /* four digits are enough, and people read them */ char text[32];
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
