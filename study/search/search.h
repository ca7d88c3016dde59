/* Internal parts of the search: axes measured in steps, evaluated points, screening, polishing by COBYLA. */
#ifndef GLINT_STUDY_SEARCH_H
#define GLINT_STUDY_SEARCH_H

#include "glint/search.h"

struct search {
    const struct glint_search_axis *axes;
    size_t count;
    const struct glint_search_options *options;
    glint_search_evaluate evaluate;
    void *user;
    struct glint_search_result *result;
    uint64_t random;
    double *scratch; /* values of the current point */
    double *planned; /* values of points that are announced next */
    size_t planned_count, planned_room;
};

/* Converts a value to steps from the lower end of its axis, 0 to axis_length, and back. For choices both are the choice. */
double axis_steps(const struct glint_search_axis *axis, double value);
double axis_length(const struct glint_search_axis *axis);
double axis_value_at(const struct glint_search_axis *axis, double steps);
/* The position of the next different value at least `step` (which may be negative) away; NAN if the range ends there. */
double axis_move(const struct glint_search_axis *axis, double from, double step);

/* search_points.c */
/* Whether both figures are finite. */
bool search_is_valid(const struct glint_search_figures *figures);
/* The point at a position in steps, which is evaluated if it is new. NULL on an error, or without an error if max_points are used up; so err->code
   must be GLINT_OK before the call. */
const struct glint_search_point *search_at(struct search *search, const double *steps, struct glint_error *err);
/* Whether the point is already evaluated. */
bool search_knows(struct search *search, const double *steps);
bool search_is_spent(const struct search *search);
/* Adds a point to those that are announced next, if it is new and max_points allow it; and announces them, if they are several. */
bool search_plan(struct search *search, const double *steps, struct glint_error *err);
bool search_announce(struct search *search, struct glint_error *err);
/* Estimates the weight of all axes with about `tries` points around the centre, whose figures are `at`: the relative change of both figures by the
   axis, or by the group that it is still in divided by its size; at most SEARCH_HEAVIEST, which is also the weight of invalid points. */
#define SEARCH_HEAVIEST 1.0
bool search_screen(struct search *search, const double *centre, const struct glint_search_figures *at, uint32_t tries,
                   double *weight, struct glint_error *err);
/* Runs COBYLA from `centre` over the listed axes, which must be numeric. */
bool search_polish(struct search *search, const double *centre, const size_t *axes, size_t count, uint32_t tries,
                   struct glint_error *err);

#endif
